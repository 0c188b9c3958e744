#include "bench/scene.h"

#include "stereomotion/geometry/so3.h"

namespace stereomotion::bench {
namespace {

RigCamera MakeCamera(const std::string& name, double side) {
  RigCamera camera;
  camera.name = name;
  camera.width_px = 1280;
  camera.height_px = 1024;
  camera.model = {1645, 1645, 639, 505, -0.07, 0.09, 5e-4, -4e-4, 0};
  camera.cam_from_world = {ExpSO3({0, side * 0.1, 0}), {0, 0, 2500}};
  return camera;
}

}  // namespace

Scenario MakeScene(int rods) {
  constexpr double kPlaces_mm[] = {-170, -110, -15, 120, 195};
  Scenario scene;
  scene.rig.cameras = {MakeCamera("cam0", 1), MakeCamera("cam1", -1)};
  for (int r = 0; r < rods; ++r) {
    Rod rod;
    rod.name = std::string(1, static_cast<char>('A' + r));
    rod.ball_diameter_mm = 14;
    for (const double place_mm : kPlaces_mm) {
      // Every rod a little longer than the one before, so that no two are alike.
      rod.balls_in_body_mm.emplace_back(place_mm * (1 + 0.06 * r), -150.0 + 95 * r,
                                        30.0 * (r % 2) + 0.2 * place_mm * r);
    }
    scene.body.rods.push_back(rod);
  }
  scene.body.name = "bench";
  scene.motion.spin_in_world_rad_s = {0.05, 0.2, 0.1};
  return scene;
}

}  // namespace stereomotion::bench
