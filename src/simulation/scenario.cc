#include "stereomotion/simulation/scenario.h"

#include <cmath>
#include <stdexcept>

#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

void Require(bool holds, const char* message) {
  if (!holds) throw std::invalid_argument(std::string("scenario: ") + message);
}

void CheckMotion(const BodyMotion& motion) {
  Require(std::fabs(motion.world_from_body.norm() - 1) < 1e-6,
          "motion.world_from_body must be a unit quaternion");
  Require(motion.center_in_body_mm.allFinite() && motion.center_in_world_mm.allFinite() &&
              motion.spin_in_world_rad_s.allFinite() &&
              motion.precession_in_world_rad_s.allFinite() &&
              motion.velocity_in_world_mm_s.allFinite(),
          "motion must be finite");
}

void CheckLight(const SceneLight& light) {
  Require(light.ball_level > 0 && light.background_level >= 0, "light levels must be positive");
  Require(light.limb_falloff >= 0 && light.limb_falloff <= 1,
          "light.limb_falloff must lie in 0 … 1");
  Require(light.blur_px >= 0 && light.blur_px < 20, "light.blur_px must lie in 0 … 20");
  Require(light.ball_slope.cwiseAbs().sum() < 2 && light.background_slope.cwiseAbs().sum() < 2,
          "light slopes make the light negative at a corner");
}

void CheckSensor(const SceneSensor& sensor) {
  Require(sensor.bits >= 8 && sensor.bits <= 16, "sensor.bits must lie in 8 … 16");
  Require(sensor.full_well_e > 0 && sensor.read_e >= 0, "sensor noise must be positive");
  Require(sensor.exposure_s >= 0, "sensor.exposure_s must not be negative");
}

void CheckRig(const Rig& rig) {
  Require(rig.cameras.size() >= 2, "the rig needs two cameras");
  for (const RigCamera& camera : rig.cameras) {
    Require(camera.width_px > 0 && camera.height_px > 0, "the rig's cameras need an image size");
  }
}

void CheckBalls(const Scenario& scenario) {
  Require(!scenario.body.rods.empty(), "the body needs a rod");
  for (const Rod& rod : scenario.body.rods) {
    Require(rod.ball_diameter_mm > 0, "ball diameters must be positive");
  }
  for (const FalseBall& ball : scenario.false_balls) {
    Require(ball.diameter_mm > 0 && ball.p_in_world_mm.allFinite(),
            "false balls need a position and a positive diameter");
  }
}

}  // namespace

BodyState StateAt(const BodyMotion& motion, double time_s) {
  const Eigen::Quaterniond precession = ExpSO3(motion.precession_in_world_rad_s * time_s);
  BodyState state;
  state.angular_velocity_in_world_rad_s =
      motion.precession_in_world_rad_s + precession * motion.spin_in_world_rad_s;
  state.center_velocity_in_world_mm_s = motion.velocity_in_world_mm_s;
  state.center_in_world_mm = motion.center_in_world_mm + motion.velocity_in_world_mm_s * time_s;
  state.world_from_body.rotation = WithPositiveW(
      (precession * ExpSO3(motion.spin_in_world_rad_s * time_s) * motion.world_from_body)
          .normalized());
  state.world_from_body.translation_mm =
      state.center_in_world_mm - state.world_from_body.rotation * motion.center_in_body_mm;
  return state;
}

double SceneSensor::full_scale_dn() const { return std::ldexp(1.0, bits) - 1; }

SensorNoise SceneSensor::noise() const {
  return {full_well_e / full_scale_dn(), read_e, 0, full_scale_dn()};
}

void CheckScenario(const Scenario& scenario) {
  CheckRig(scenario.rig);
  CheckBalls(scenario);
  CheckMotion(scenario.motion);
  CheckLight(scenario.light);
  CheckSensor(scenario.sensor);
  Require(scenario.frames > 0, "frames must be positive");
  Require(scenario.fps > 0 && std::isfinite(scenario.fps), "fps must be positive");
  Require(std::isfinite(scenario.lag_s), "lag_s must be finite");
}

FrameTime TimeOfFrame(const Scenario& scenario, int camera, std::int64_t frame) {
  constexpr std::int64_t kFirst_ns = 1000000000;
  const std::int64_t since_first_ns = std::llround(1e9 * static_cast<double>(frame) / scenario.fps);
  const double lag_s = camera == 1 ? scenario.lag_s : 0.0;
  FrameTime time;
  time.true_s = static_cast<double>(since_first_ns) * 1e-9 + lag_s;
  time.timestamp_ns = kFirst_ns + since_first_ns +
                      (scenario.lag_reported ? std::llround(1e9 * lag_s) : std::int64_t{0});
  return time;
}

}  // namespace stereomotion
