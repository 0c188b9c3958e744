#pragma once

#include <Eigen/Core>
#include <optional>

#include "stereomotion/calibration/adjust_bundle.h"
#include "stereomotion/camera/rig.h"

namespace stereomotion {

/// Holds where a camera sees a point of a target, with derivatives.
struct PointImage {
  Eigen::Vector2d pixel_px;  ///< of the outline's centre for balls and circles
  Eigen::Matrix<double, 2, 3> d_world;
  Eigen::Matrix<double, 2, RigParameter::kPerCamera> d_camera;
};

/// Predicts the image of a point: a corner's projection, or the centre of a ball's or circle's
/// outline. The derivatives are those of the point's own projection: the outline's shift against it
/// changes 10⁴ times more slowly. Nothing where the camera cannot see it.
std::optional<PointImage> PredictImage(const RigCamera& camera, const Rigid3& world_from_target,
                                       const BundlePoint& point);

/// Finds how far the centre of the image of a flat circle (in the target's xy plane) lies from the
/// projection of its centre [px]: perspective and distortion move it (Heikkilä 2000). Nothing where
/// the camera cannot see all of it.
std::optional<Eigen::Vector2d> CircleShift(const RigCamera& camera, const Rigid3& world_from_target,
                                           const Eigen::Vector3d& center_in_target_mm,
                                           double radius_mm);

}  // namespace stereomotion
