#pragma once

#include "stereomotion/geometry/so3.h"
#include "stereomotion/simulation/scenario.h"

namespace stereomotion::testing {

/// Makes a camera that looks along its z axis at the world's origin from `distance_mm`, turned
/// about the vertical by `yaw_rad`.
inline RigCamera MakeTestCamera(const char* name, double yaw_rad, double distance_mm) {
  RigCamera camera;
  camera.name = name;
  camera.width_px = 320;
  camera.height_px = 256;
  camera.model = {840, 842, 158.7, 129.2, -0.11, 0.08, 4e-4, -6e-4, 0};
  camera.cam_from_world.rotation = ExpSO3({0, yaw_rad, 0});
  camera.cam_from_world.translation_mm = {0, 0, distance_mm};
  return camera;
}

/// Makes a small scene: two rods of five 14 mm balls, 9 px large, 1.3 m away.
inline Scenario MakeTestScenario() {
  Scenario scenario;
  scenario.name = "test";
  scenario.rig.cameras = {MakeTestCamera("cam0", 0.25, 1300), MakeTestCamera("cam1", -0.25, 1280)};
  scenario.body.name = "cross";
  scenario.body.rods = {
      {"A", 14, {{-90, 0, 0}, {-60, 0, 0}, {-15, 0, 0}, {35, 0, 0}, {95, 0, 0}}, 0},
      {"B", 14, {{0, -80, 30}, {0, -45, 30}, {0, -20, 30}, {0, 30, 30}, {0, 70, 30}}, 0}};
  scenario.motion.center_in_body_mm = {20, -10, 15};
  scenario.motion.center_in_world_mm = {5, 3, -8};
  scenario.motion.world_from_body = ExpSO3({0.1, 0.2, -0.3});
  scenario.motion.spin_in_world_rad_s = {0.3, 0.5, 1.2};
  scenario.light.background_level = 0.03;
  scenario.frames = 3;
  return scenario;
}

}  // namespace stereomotion::testing
