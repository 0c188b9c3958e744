#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "stereomotion/camera/camera.h"

namespace stereomotion {

/// Holds the rays (X/Z, Y/Z) of all pixel corners of a rectangle of the image plane.
///
/// Between corners the rays are bilinear: over one pixel the distortion's second derivative
/// (≈ 6 k1 x / f² a pixel²) leaves less than 1e-4 px.
class RayGrid {
 public:
  /// Nothing where a corner lies beyond the camera model's field.
  static std::optional<RayGrid> Make(const CameraModel& model, const Eigen::Vector2i& origin_px,
                                     const Eigen::Vector2i& size_px);

  /// Finds the ray of a point of the rectangle.
  [[nodiscard]] Eigen::Vector3d RayAt(const Eigen::Vector2d& point_px) const;

 private:
  Eigen::Vector2i origin_px_;
  Eigen::Vector2i size_px_;
  std::vector<Eigen::Vector2d> corners_;  ///< (size + 1)², row by row
};

}  // namespace stereomotion
