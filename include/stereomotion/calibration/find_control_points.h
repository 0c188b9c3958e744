#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "stereomotion/calibration/target.h"
#include "stereomotion/core/expected.h"
#include "stereomotion/core/image.h"
#include "stereomotion/core/sensor_noise.h"
#include "stereomotion/detection/ball_observation.h"

namespace stereomotion {

/// Holds the rough place of a control point in an image, as the user gave it (± 15 px).
struct Seed {
  int point = -1;  ///< index into `Target::points`
  Eigen::Vector2d pixel_px = Eigen::Vector2d::Zero();
};

/// Holds a detected ball and the point of the target that it is.
struct LabelledBall {
  int point = -1;  ///< index into `Target::points`
  BallObservation ball;
};

/// Holds the labelled balls of one image, by ascending point.
struct ControlPointView {
  std::vector<LabelledBall> balls;
  Eigen::Matrix<double, 3, 4> dlt =
      Eigen::Matrix<double, 3,
                    4>::Zero();  ///< image from target coordinates, from the labelled balls
  int num_detected = 0;          ///< blobs before labelling
  /// Points whose seeds lie elsewhere than the labels that all other balls agree on: wrong or
  /// exchanged ids, to be told to the user.
  std::vector<int> contradicting_seeds;
};

/// Says why an image's balls could not be labelled.
enum class LabelFailure {
  kTooFewBalls,     ///< fewer than six points have a ball near their seed
  kFlat,            ///< the points with a seed lie in a plane: a DLT is not determined
  kMirrored,        ///< the points fit only as their mirror image (a left-handed survey)
  kMislabelled,     ///< no DLT fits the seeds to within their uncertainty
  kNotIdentifiable  ///< no seeds, and the arrangement of rods does not tell the points apart
};

struct LabelProblem {
  LabelFailure failure;
  std::vector<int> suspects;  ///< points whose seeds contradict the others
  std::string text;           ///< for a person: what was found, what was expected
};

/// Finds and labels the control points in one image of a static frame.
///
/// The engine's own detector finds blobs, dim ones too. Subsets of the seeds, each with the blobs
/// near it, propose cameras of square pixels; the labels grow outwards from each (predict, take the
/// nearest blob within a gate that the prediction's own uncertainty sets, one to one, refit), and
/// the camera that explains most blobs wins; so a wrong seed does no harm. With distortion fitted,
/// every point is then measured where it is predicted: by the detector's fit where that explains
/// the pixels, else by `MeasureBall` (dim, glinting, scratched balls), whose covariance says so.
/// Without seeds, points that lie on lines (rods of four or more) are recognised by their
/// cross-ratios. Deterministic. Throws std::invalid_argument for a target without balls and for
/// seeds that name no point or one twice.
Expected<ControlPointView, LabelProblem> FindControlPoints(const ImageView& image,
                                                           const SensorNoise& noise,
                                                           const Target& target,
                                                           const std::vector<Seed>& seeds);

}  // namespace stereomotion
