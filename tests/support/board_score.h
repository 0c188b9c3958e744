#pragma once

#include <Eigen/Core>
#include <vector>

#include "stereomotion/calibration/target.h"
#include "stereomotion/calibration/target_observation.h"
#include "stereomotion/camera/rig.h"

namespace stereomotion::testing {

/// Gathers how well a rig explains a board's corners in image pairs that it was not calibrated
/// with.
struct BoardScore {
  double epipolar_px2 = 0, stereo_px2 = 0;  ///< sums of squares
  int epipolar_count = 0, stereo_count = 0;

  /// RMS distance of a corner to the epipolar line of its partner in the other image.
  [[nodiscard]] double EpipolarPx() const;
  /// RMS residual per corner and image, as OpenCV's stereoCalibrate counts it, with the board's
  /// pose fitted to both images.
  [[nodiscard]] double StereoPx() const;
};

/// Adds one image pair: the corners of view `view`. The distances to epipolar lines are taken
/// between undistorted rays and counted in pixels of the focal length. `points_mm`: the board's
/// corners. Throws std::runtime_error where a corner has no ray or the board no pose.
void AddPair(const Rig& rig, const std::vector<Eigen::Vector3d>& points_mm,
             const std::vector<TargetObservation>& observations, int view, BoardScore& score);

}  // namespace stereomotion::testing
