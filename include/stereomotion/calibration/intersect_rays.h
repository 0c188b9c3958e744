#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "stereomotion/camera/rig.h"

namespace stereomotion {

/// Holds where one camera of a rig saw a point.
struct Sight {
  int camera = 0;
  Eigen::Vector2d pixel_px = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance_px2 = Eigen::Matrix2d::Identity();
};

/// Holds a point that two or more cameras saw.
struct IntersectedPoint {
  Eigen::Vector3d p_in_world_mm = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_mm2 = Eigen::Matrix3d::Zero();  ///< random part: of the sights
  /// ∂ point / ∂ the 15 parameters of every camera of the rig (3 × 15 N); see `RigParameter`.
  Eigen::Matrix3Xd d_rig;
  double chi2 = 0;
};

/// Finds the world point that fits all sights best: whitened reprojection error, Gauss–Newton from
/// the point nearest to the rays. `ball_radius_mm` > 0: the sights are centres of a ball's outline.
/// Nothing for fewer than two sights, rays that are nearly parallel or a point behind a camera.
std::optional<IntersectedPoint> IntersectRays(const std::vector<RigCamera>& cameras,
                                              const std::vector<Sight>& sights,
                                              double ball_radius_mm = 0);

/// Propagates a rig's covariance to the point: 3 × 3 [mm²].
Eigen::Matrix3d CalibrationCovariance(const IntersectedPoint& point,
                                      const RigCovariance& covariance);

}  // namespace stereomotion
