#pragma once

#include <Eigen/Core>
#include <optional>

#include "stereomotion/geometry/rigid3.h"

namespace stereomotion {

/// Says why a frame pair has no pose (words: docs/formats.md).
enum class PoseStatus {
  kOk,
  kNoPair,            ///< the left image has no right one within half a period
  kUnreadable,        ///< an image is missing, truncated or of the wrong size
  kTooFewBalls,       ///< not enough balls for a pose that a single false ball could not bend
  kLost,              ///< balls were seen, but no arrangement of them fits the body
  kAmbiguous,         ///< two different poses explain the images about equally well
  kRollUndetermined,  ///< only one rod of several was seen: roll about it is open
  kInconsistent,      ///< the cameras contradict each other far more than in the frames before
  kDropped,           ///< live: the images came, but measuring was too slow for them
};

/// Holds the pose of a body in one frame pair.
struct PoseEstimate {
  Rigid3 world_from_body;
  /// Random covariance of the left perturbation (δθ, δt) in world axes [rad, mm]; zero along a free
  /// rotation axis (there the variance is infinite).
  Matrix6d covariance = Matrix6d::Zero();
  /// Standard uncertainty of the common part (rig, body); nothing where the rig carries none.
  std::optional<Vector6d> calibration_u;
  /// World unit axis about which the rotation is not determined (single rod); then
  /// `world_from_body.translation_mm` is the position of the rod's first ball.
  std::optional<Eigen::Vector3d> free_axis_in_world;
  double rms_px = 0;  ///< of the residuals of all used observations, per coordinate
  double chi2 = 0;    ///< of the residuals, whitened
  int dof = 0;
  int balls_left = 0;  ///< observations used
  int balls_right = 0;
};

}  // namespace stereomotion
