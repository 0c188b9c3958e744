#include "bench/exposure_scene.h"

#include <cmath>
#include <string>

#include "stereomotion/geometry/so3.h"

namespace stereomotion::bench {
namespace {

constexpr double kFocal_px = 1645;
constexpr double kDistance_mm = 2500;

RigCamera MakeCamera(const std::string& name, double side) {
  constexpr int kWidth_px = 256;
  constexpr int kHeight_px = 192;
  RigCamera camera;
  camera.name = name;
  camera.width_px = kWidth_px;
  camera.height_px = kHeight_px;
  camera.model = {kFocal_px, kFocal_px, (kWidth_px - 1) / 2.0, (kHeight_px - 1) / 2.0, 0, 0, 0,
                  0,         0};
  camera.cam_from_world = {ExpSO3({0, side * 0.2, 0}), {0, 0, kDistance_mm}};
  return camera;
}

Rod MakeRod(const std::string& name, double y_mm, double stretch) {
  Rod rod;
  rod.name = name;
  rod.ball_diameter_mm = 14;
  for (const double place_mm : {-100.0, -58.0, 5.0, 45.0, 108.0}) {
    rod.balls_in_body_mm.emplace_back(stretch * place_mm, y_mm, 0.3 * y_mm);
  }
  return rod;
}

}  // namespace

Scenario MakeExposureScene(const ExposureCondition& condition) {
  Scenario scene;
  scene.rig.cameras = {MakeCamera("cam0", 1), MakeCamera("cam1", -1)};
  scene.body.name = "target";
  scene.body.rods = {MakeRod("A", -45, 1), MakeRod("B", 45, -1.1)};
  scene.motion.velocity_in_world_mm_s = condition.speed_mm_s * MotionDirection();
  scene.light.ball_level = condition.ball_level;
  scene.sensor.bits = 12;  // rounding plays no part even in weak light
  // Background and ball fade together, as they do with the lamp or the exposure.
  scene.light.background_level = 0.1 * condition.ball_level;
  scene.sensor.exposure_s = condition.exposure_s;
  return scene;
}

Eigen::Vector3d MotionDirection() { return Eigen::Vector3d(0.96, 0.28, 0); }

double SmearPx(const ExposureCondition& condition) {
  return condition.speed_mm_s * condition.exposure_s * kFocal_px / kDistance_mm;
}

}  // namespace stereomotion::bench
