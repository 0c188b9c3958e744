#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "stereomotion/camera/sphere_projection.h"
#include "stereomotion/core/body.h"
#include "stereomotion/simulation/scenario.h"

namespace stereomotion {

/// Holds one sphere of the scene as one camera sees it at one instant.
struct SceneBall {
  BallId id;  ///< rod = −1: a false ball
  Eigen::Vector3d p_in_world_mm;
  Eigen::Vector3d p_in_cam_mm;
  double radius_mm = 0;
  std::optional<SphereProjection> projection;  ///< nothing where the camera cannot see it

  /// Distance of a ray (X/Z, Y/Z, 1) from the ball's centre, in radii: 1 on the outline.
  [[nodiscard]] double Rho(const Eigen::Vector3d& ray) const {
    return p_in_cam_mm.cross(ray).norm() / (ray.norm() * radius_mm);
  }
};

/// Lists all spheres, the body's rod by rod, then the false ones; always the same order and number.
std::vector<SceneBall> SceneBallsAt(const Scenario& scenario, int camera, double time_s);

/// Lists the balls that may hide a part of `balls[hidden]`: nearer ones whose outlines reach it.
std::vector<int> NearerBalls(const std::vector<SceneBall>& balls, int hidden);

}  // namespace stereomotion
