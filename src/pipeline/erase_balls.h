#pragma once

#include <Eigen/Core>
#include <vector>

#include "stereomotion/camera/rig.h"
#include "stereomotion/core/image.h"

namespace stereomotion {

/// A ball of the body in one image.
struct BodyBall {
  Eigen::Vector2d center_px;
  double radius_px = 0;
};
/// Overwrites balls row by row with the darker of what is left and right of them.
void Erase(const std::vector<BodyBall>& balls, const RigCamera& camera, Image& image);

}  // namespace stereomotion
