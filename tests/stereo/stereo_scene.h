#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "stereomotion/camera/rig.h"
#include "stereomotion/camera/sphere_projection.h"
#include "stereomotion/detection/ball_observation.h"
#include "stereomotion/geometry/so3.h"

namespace stereomotion::testing {

/// Places a camera at `position_mm` that looks at the world's origin.
inline Rigid3 LookAtOrigin(const Eigen::Vector3d& position_mm) {
  Eigen::Matrix3d world_from_cam;
  world_from_cam.col(2) = -position_mm.normalized();
  world_from_cam.col(0) = Eigen::Vector3d::UnitY().cross(world_from_cam.col(2)).normalized();
  world_from_cam.col(1) = world_from_cam.col(2).cross(world_from_cam.col(0));
  return Rigid3{Eigen::Quaterniond(world_from_cam), position_mm}.Inverse();
}

/// Holds two distorted, converging cameras 2.5 m from the origin, 20° apart.
struct StereoScene {
  RigCamera left, right;

  StereoScene() {
    left.name = "cam0";
    left.model = {1643, 1644, 639, 494, -0.07, 0.087, 5.8e-4, -3.2e-4, -1.1e-3};
    left.cam_from_world = LookAtOrigin({-440, 30, -2460});
    right.name = "cam1";
    right.model = {1647, 1646, 651, 501, -0.05, 0.12, 4.4e-4, -5e-4, 0.016};
    right.cam_from_world = LookAtOrigin({440, -20, -2460});
    left.width_px = right.width_px = 1280;
    left.height_px = right.height_px = 1024;
  }
};

/// Makes the observation that an ideal detector has of a ball.
inline BallObservation Observe(const RigCamera& camera, const Eigen::Vector3d& p_in_world_mm,
                               double radius_mm, double sigma_px = 0.01) {
  const auto seen = ProjectSphere(camera.model, camera.cam_from_world * p_in_world_mm, radius_mm);
  BallObservation ball;
  ball.center_px = seen.value().outline.center_px;
  ball.semi_major_px = seen->outline.semi_major_px;
  ball.semi_minor_px = seen->outline.semi_minor_px;
  ball.covariance_px2 = sigma_px * sigma_px * Eigen::Matrix2d::Identity();
  return ball;
}

/// Bounds χ² with many degrees of freedom at z standard deviations (Wilson & Hilferty 1931).
inline double Chi2Quantile(double dof, double z) {
  const double a = 2 / (9 * dof);
  return dof * std::pow(1 - a + z * std::sqrt(a), 3);
}

/// Six two-sided checks in one program at a family-wise level of 99.9 % (Šidák): 1 − 0.999^(1/6)
/// in both tails.
constexpr double kFamilyZ = 3.77;

}  // namespace stereomotion::testing
