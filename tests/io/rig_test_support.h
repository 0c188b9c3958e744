#pragma once

#include <string>

#include "stereomotion/camera/rig.h"
#include "stereomotion/geometry/so3.h"
#include "tests/support/test_rng.h"

namespace stereomotion::testing {

/// Makes two converging cameras, 1.2 m apart and 2 m before the world's origin, with all numbers
/// drawn at random about that.
inline Rig RandomRig(std::mt19937_64& rng, bool distorted = true) {
  Rig rig;
  for (const double side : {-1.0, 1.0}) {
    RigCamera camera;
    camera.name = side < 0 ? "cam0" : "cam1";
    camera.width_px = 1280;
    camera.height_px = 1024;
    const double f_px = Uniform(rng, 1500, 1900);
    camera.model = {f_px, f_px * 1.001, Uniform(rng, 600, 680), Uniform(rng, 480, 540)};
    if (distorted) {
      camera.model.k1 = Uniform(rng, -0.2, 0.1), camera.model.k2 = Uniform(rng, -0.1, 0.1);
      camera.model.p1 = Uniform(rng, -1e-3, 1e-3), camera.model.p2 = Uniform(rng, -1e-3, 1e-3);
      camera.model.k3 = Uniform(rng, -0.1, 0.1);
    }
    const Eigen::Vector3d turn_rad = 0.1 * NormalVector<3>(rng);
    camera.cam_from_world = {ExpSO3(turn_rad + Eigen::Vector3d(0, side * 0.3, 0)),
                             NormalVector<3>(rng) * 20 + Eigen::Vector3d(side * -10, 0, 2000)};
    rig.cameras.push_back(camera);
  }
  return rig;
}

/// Finds how far the images of points about the world's origin lie apart in two rigs of the same
/// cameras, whose worlds differ by `b_from_a`.
inline double LargestImageDistancePx(const Rig& a, const Rig& b, const Rigid3& b_from_a,
                                     std::mt19937_64& rng) {
  double largest_px = 0;
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d p_mm = 200 * NormalVector<3>(rng).cwiseMax(-2).cwiseMin(2);
    for (std::size_t camera = 0; camera < a.cameras.size(); ++camera) {
      const auto first = ProjectWorldPoint(a.cameras[camera], p_mm);
      const auto second = ProjectWorldPoint(b.cameras[camera], b_from_a * p_mm);
      if (!first || !second) return 1e9;
      largest_px = std::max(largest_px, (*first - *second).norm());
    }
  }
  return largest_px;
}

/// A thousand roundings of double precision on coordinates of some thousand px.
constexpr double kRoundingPx = 1e-9;

}  // namespace stereomotion::testing
