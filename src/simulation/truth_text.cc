#include "truth_text.h"

#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>

#include "stereomotion/simulation/render_scene.h"

namespace stereomotion {
namespace {

nlohmann::ordered_json ToJson(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
nlohmann::ordered_json ToJson(const Eigen::Vector2d& v) { return {v.x(), v.y()}; }

// Fixed decimals, a thousandth of what any image can tell: digits near the end of a double would
// differ between compilers.
std::string Cells(const Eigen::Vector3d& v) {
  return fmt::format("{:.6f},{:.6f},{:.6f}", v.x(), v.y(), v.z());
}
std::string Cells(const Eigen::Vector2d& v) { return fmt::format("{:.6f},{:.6f}", v.x(), v.y()); }
std::string Cells(const Eigen::Quaterniond& q) {
  return fmt::format("{:.10f},{:.10f},{:.10f},{:.10f}", q.w(), q.x(), q.y(), q.z());
}

}  // namespace

std::string TimestampsCsv(const Scenario& scenario, int camera) {
  fmt::memory_buffer text;
  auto out = std::back_inserter(text);
  fmt::format_to(out, "frame,timestamp_ns,exposure_us\n");
  for (int frame = 0; frame < scenario.frames; ++frame) {
    fmt::format_to(out, "{},{},{:.12g}\n", frame, TimeOfFrame(scenario, camera, frame).timestamp_ns,
                   scenario.sensor.exposure_s * 1e6);
  }
  return to_string(text);
}

std::string TruePosesCsv(const Scenario& scenario) {
  fmt::memory_buffer text;
  auto out = std::back_inserter(text);
  fmt::format_to(out,
                 "frame,timestamp_ns,qw,qx,qy,qz,tx_mm,ty_mm,tz_mm,wx_rad_s,wy_rad_s,wz_rad_s,"
                 "center_x_mm,center_y_mm,center_z_mm,vx_mm_s,vy_mm_s,vz_mm_s\n");
  for (int frame = 0; frame < scenario.frames; ++frame) {
    const FrameTime time = TimeOfFrame(scenario, 0, frame);
    const BodyState state = StateAt(scenario.motion, time.true_s);
    fmt::format_to(out, "{},{},{},{},{},{},{}\n", frame, time.timestamp_ns,
                   Cells(state.world_from_body.rotation),
                   Cells(state.world_from_body.translation_mm),
                   Cells(state.angular_velocity_in_world_rad_s), Cells(state.center_in_world_mm),
                   Cells(state.center_velocity_in_world_mm_s));
  }
  return to_string(text);
}

std::string TrueBallsCsv(const Scenario& scenario) {
  fmt::memory_buffer text;
  auto out = std::back_inserter(text);
  fmt::format_to(out,
                 "frame,camera,rod,ball,x_mm,y_mm,z_mm,u_px,v_px,outline_u_px,outline_v_px,"
                 "diameter_px,visible,inside\n");
  for (int frame = 0; frame < scenario.frames; ++frame) {
    for (const int camera : {0, 1}) {
      const double time_s = TimeOfFrame(scenario, camera, frame).true_s;
      for (const BallTruth& ball : BallTruths(scenario, camera, time_s)) {
        fmt::format_to(out, "{},{},{},{},{},{},{},{:.6f},{:.4g},{}\n", frame,
                       scenario.rig.cameras[camera].name, scenario.body.rods[ball.id.rod].name,
                       ball.id.ball, Cells(ball.p_in_world_mm), Cells(ball.center_px),
                       Cells(ball.outline_px), ball.diameter_px, ball.visible, ball.inside ? 1 : 0);
      }
    }
  }
  return to_string(text);
}

std::string SceneJson(const Scenario& scenario) {
  const SceneLight& light = scenario.light;
  const SceneSensor& sensor = scenario.sensor;
  const BodyMotion& motion = scenario.motion;
  nlohmann::ordered_json json;
  json["scenario"] = scenario.name;
  json["law"] = motion.law;
  json["frames"] = scenario.frames;
  json["fps"] = scenario.fps;
  json["exposure"] = sensor.exposure_s;
  json["amp"] = light.ball_level;
  json["bg"] = light.background_level;
  json["amp_slope"] = ToJson(light.ball_slope);
  json["bg_slope"] = ToJson(light.background_slope);
  json["limb_falloff"] = light.limb_falloff;
  json["psf"] = light.blur_px;
  json["bits"] = sensor.bits;
  json["full_well"] = sensor.full_well_e;
  json["read"] = sensor.read_e;
  json["lag"] = scenario.lag_s;
  json["lag_reported"] = scenario.lag_reported;
  json["seed"] = scenario.seed;
  json["false_balls"] = scenario.false_balls.size();
  json["spin_centre_body"] = ToJson(motion.center_in_body_mm);
  json["spin_rad_s"] = ToJson(motion.spin_in_world_rad_s);
  json["precession_rad_s"] = ToJson(motion.precession_in_world_rad_s);
  return json.dump(1) + "\n";
}

}  // namespace stereomotion
