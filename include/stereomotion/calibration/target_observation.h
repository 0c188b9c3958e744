#pragma once

#include <Eigen/Core>

namespace stereomotion {

/// Holds the image of one point of a target: where camera `camera` saw point `point` (index into
/// `Target::points`) in view `view` (image pair).
struct TargetObservation {
  int camera = 0;
  int view = 0;
  int point = 0;
  /// Balls and circles: the centre of the outline (perspective shift NOT removed); corners: the
  /// corner.
  Eigen::Vector2d pixel_px = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance_px2 = Eigen::Matrix2d::Identity();
  double diameter_px = 0;  ///< of a ball's or circle's outline; 0: a corner
  double blur_px = 0;      ///< width of the edges there, a Gaussian's σ; 0: unknown
};

}  // namespace stereomotion
