#pragma once

#include <Eigen/Core>
#include <optional>

#include "stereomotion/camera/camera.h"

namespace stereomotion {

/// Describes an ellipse in the image by its centre and semi-axes.
struct ImageEllipse {
  Eigen::Vector2d center_px = Eigen::Vector2d::Zero();
  double semi_major_px = 0;
  double semi_minor_px = 0;
  double angle_rad = 0;  ///< of the major axis, from +u towards +v, in (−π/2, π/2]
};

/// Predicts the image of a sphere and how far its outline's centre lies from the projection of the
/// sphere's own centre.
struct SphereProjection {
  Eigen::Vector2d center_px;  ///< projection of the sphere's centre
  ImageEllipse outline;       ///< centroid and equal-area, equal-moment ellipse of the outline
  Eigen::Vector2d shift_px() const { return outline.center_px - center_px; }
};

/// Projects a sphere of radius `radius_mm` at `center_in_cam_mm` (camera frame).
///
/// The outline is the cone `c cᵀ − (cᵀc − r²) I`, an ellipse in the undistorted image (Hartley &
/// Zisserman 2004, sec. 8.3). Its distorted image is integrated by a cubature of fifth order.
/// Agrees with the silhouette traced through the distortion to ≤ 1e-4 px for balls up to 40 px.
/// Nothing where the sphere touches or lies behind the camera plane or outside the valid field;
/// throws std::invalid_argument for a negative radius.
std::optional<SphereProjection> ProjectSphere(const CameraModel& camera,
                                              const Eigen::Vector3d& center_in_cam_mm,
                                              double radius_mm);

}  // namespace stereomotion
