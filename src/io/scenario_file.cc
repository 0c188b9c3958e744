#include "stereomotion/io/scenario_file.h"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "stereomotion/core/user_error.h"
#include "stereomotion/io/body_file.h"
#include "stereomotion/io/rig_file.h"
#include "yaml_reader.h"

namespace stereomotion {
namespace {

void ReadNumber(const YamlReader& map, const char* key, double& value) {
  if (const auto node = map.Optional(key)) value = node->NotNegative();
}

void ReadVector(const YamlReader& map, const char* key, Eigen::Vector3d& value) {
  if (const auto node = map.Optional(key)) value = node->Vector3();
}

void ReadSlope(const YamlReader& map, const char* key, Eigen::Vector2d& value) {
  const auto node = map.Optional(key);
  if (!node) return;
  const std::vector<double> slope = node->Numbers(2);
  value = {slope[0], slope[1]};
}

Eigen::Vector3d ReadAxis(const YamlReader& map, const char* key) {
  const YamlReader node = map.Required(key);
  const Eigen::Vector3d axis = node.Vector3();
  if (axis.norm() < 1e-6) node.Fail("a vector of length 0", "a direction");
  return axis.normalized();
}

Eigen::Quaterniond ReadQuaternion(const YamlReader& node) {
  node.RequireKeys({"qw", "qx", "qy", "qz"});
  const Eigen::Quaterniond q(node.Required("qw").Number(), node.Required("qx").Number(),
                             node.Required("qy").Number(), node.Required("qz").Number());
  constexpr double kRounding = 1e-3;  // of a quaternion typed with three or four digits
  if (std::fabs(q.norm() - 1) > kRounding) {
    node.Fail("a quaternion of length " + std::to_string(q.norm()), "length 1");
  }
  return q.normalized();
}

std::vector<std::string> KeysOfLaw(const YamlReader& law) {
  std::vector<std::string> keys = {"law",  "center_in_body_mm", "center_in_world_mm",
                                   "axis", "rate_rad_s",        "world_from_body"};
  const std::string name = law.Text();
  if (name == "uniform") {
    keys.emplace_back("velocity_mm_s");
  } else if (name == "screw") {
    keys.emplace_back("pitch_mm_per_rad");
  } else if (name == "precession") {
    keys.insert(keys.end(), {"precession_axis", "precession_rate_rad_s", "velocity_mm_s"});
  } else if (name != "fixed") {
    law.Fail("'" + name + "'", "fixed, uniform, screw or precession");
  }
  return keys;
}

BodyMotion ReadMotion(const YamlReader& node) {
  const YamlReader law = node.Required("law");
  node.RequireKeys(KeysOfLaw(law));
  BodyMotion motion;
  motion.law = law.Text();
  ReadVector(node, "center_in_body_mm", motion.center_in_body_mm);
  ReadVector(node, "center_in_world_mm", motion.center_in_world_mm);
  if (const auto q = node.Optional("world_from_body")) motion.world_from_body = ReadQuaternion(*q);
  motion.spin_in_world_rad_s = ReadAxis(node, "axis") * node.Required("rate_rad_s").Number();
  if (motion.law == "uniform") {
    motion.velocity_in_world_mm_s = node.Required("velocity_mm_s").Vector3();
  } else if (motion.law == "screw") {
    const double pitch_mm_per_rad = node.Required("pitch_mm_per_rad").Number();
    motion.velocity_in_world_mm_s = pitch_mm_per_rad * motion.spin_in_world_rad_s;
  } else if (motion.law == "precession") {
    motion.precession_in_world_rad_s =
        ReadAxis(node, "precession_axis") * node.Required("precession_rate_rad_s").Number();
    ReadVector(node, "velocity_mm_s", motion.velocity_in_world_mm_s);
  }
  return motion;
}

SceneLight ReadLight(const YamlReader& node) {
  node.RequireKeys({"ball_level", "background_level", "limb_falloff", "ball_slope",
                    "background_slope", "blur_px"});
  SceneLight light;
  ReadNumber(node, "ball_level", light.ball_level);
  ReadNumber(node, "background_level", light.background_level);
  ReadNumber(node, "limb_falloff", light.limb_falloff);
  ReadSlope(node, "ball_slope", light.ball_slope);
  ReadSlope(node, "background_slope", light.background_slope);
  ReadNumber(node, "blur_px", light.blur_px);
  return light;
}

SceneSensor ReadSensor(const YamlReader& node) {
  node.RequireKeys({"bits", "full_well_e", "read_e", "exposure_s"});
  SceneSensor sensor;
  if (const auto bits = node.Optional("bits")) sensor.bits = bits->Integer(8, 16);
  ReadNumber(node, "full_well_e", sensor.full_well_e);
  ReadNumber(node, "read_e", sensor.read_e);
  ReadNumber(node, "exposure_s", sensor.exposure_s);
  return sensor;
}

std::vector<FalseBall> ReadFalseBalls(const YamlReader& node) {
  std::vector<FalseBall> balls;
  for (const YamlReader& item : node.Items()) {
    item.RequireKeys({"xyz_mm", "diameter_mm"});
    balls.push_back({item.Required("xyz_mm").Vector3(), item.Required("diameter_mm").Positive()});
  }
  return balls;
}

bool ReadFlag(const YamlReader& node) {
  const std::string text = node.Text();
  if (text != "true" && text != "false") node.Fail("'" + text + "'", "true or false");
  return text == "true";
}

void ReadRun(const YamlReader& root, Scenario& scenario) {
  constexpr int kMostFrames = 1'000'000;  // the images' names have six digits
  scenario.frames = root.Required("frames").Integer(1, kMostFrames);
  scenario.fps = root.Required("fps").Positive();
  if (const auto seed = root.Optional("seed")) {
    scenario.seed = static_cast<std::uint64_t>(seed->Integer(0, std::numeric_limits<int>::max()));
  }
  if (const auto lag = root.Optional("lag_s")) scenario.lag_s = lag->Number();
  if (const auto told = root.Optional("lag_reported")) scenario.lag_reported = ReadFlag(*told);
}

void CheckFormat(const YamlReader& root) {
  const YamlReader format = root.Required("format");
  if (format.Text() != "stereomotion-scenario/1") {
    format.Fail("'" + format.Text() + "'", "'stereomotion-scenario/1'");
  }
  root.RequireKeys({"format", "name", "rig", "body", "motion", "light", "sensor", "false_balls",
                    "frames", "fps", "lag_s", "lag_reported", "seed"});
}

}  // namespace

ScenarioFile ReadScenario(const std::filesystem::path& file) {
  const YamlReader root = YamlReader::Load(file);
  CheckFormat(root);
  ScenarioFile read;
  read.rig = file.parent_path() / root.Required("rig").Text();
  read.body = file.parent_path() / root.Required("body").Text();
  Scenario& scenario = read.scenario;
  scenario.name = file.stem().string();
  if (const auto name = root.Optional("name")) scenario.name = name->Name();
  scenario.motion = ReadMotion(root.Required("motion"));
  if (const auto light = root.Optional("light")) scenario.light = ReadLight(*light);
  if (const auto sensor = root.Optional("sensor")) scenario.sensor = ReadSensor(*sensor);
  if (const auto balls = root.Optional("false_balls"))
    scenario.false_balls = ReadFalseBalls(*balls);
  ReadRun(root, scenario);
  scenario.rig = ReadRig(read.rig);
  scenario.body = ReadBody(read.body);
  try {
    CheckScenario(scenario);
  } catch (const std::invalid_argument& error) {
    throw UserError(file.string() + ": " + error.what());
  }
  return read;
}

}  // namespace stereomotion
