#include <cmath>

#include "camera_source.h"
#include "rig_formats.h"
#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

SensorNoise ReadNoise(const YamlReader& node) {
  node.RequireKeys({"gain_e_per_dn", "read_e", "black_dn", "saturation_dn"});
  SensorNoise noise;
  noise.gain_e_per_dn = node.Required("gain_e_per_dn").Positive();
  noise.read_e = node.Required("read_e").NotNegative();
  if (const auto black = node.Optional("black_dn")) noise.black_dn = black->Number();
  if (const auto top = node.Optional("saturation_dn")) noise.saturation_dn = top->Positive();
  if (noise.saturation_dn <= noise.black_dn) node.Fail("saturation_dn below black_dn", "above");
  return noise;
}

// One model for all cameras, or a key a camera.
void ReadNoises(const YamlReader& node, Rig& rig) {
  if (node.Has("gain_e_per_dn") || node.Has("read_e")) {
    const SensorNoise noise = ReadNoise(node);
    for (RigCamera& camera : rig.cameras) camera.noise = noise;
    return;
  }
  std::vector<std::string> names;
  for (const RigCamera& camera : rig.cameras) names.push_back(camera.name);
  std::vector<std::string> known = names;
  known.insert(known.end(), {"gain_e_per_dn", "read_e", "black_dn", "saturation_dn"});
  node.RequireKeys(known);
  for (RigCamera& camera : rig.cameras) {
    if (const auto own = node.Optional(camera.name)) camera.noise = ReadNoise(*own);
  }
}

Rigid3 ReadPose(const YamlReader& node) {
  node.RequireKeys({"qw", "qx", "qy", "qz", "tx_mm", "ty_mm", "tz_mm"});
  const auto number = [&](const char* key) { return node.Required(key).Number(); };
  const Eigen::Quaterniond q(number("qw"), number("qx"), number("qy"), number("qz"));
  constexpr double kTolerance = 1e-3;  // more than any rounding that a person would write
  if (std::abs(q.norm() - 1) > kTolerance) {
    node.Fail("a quaternion of norm " + std::to_string(q.norm()), "norm 1");
  }
  return {WithPositiveW(q.normalized()), {number("tx_mm"), number("ty_mm"), number("tz_mm")}};
}

void ReadDistortion(const YamlReader& node, CameraModel& model) {
  const std::vector<double> k = node.Numbers();
  if (k.size() != 4 && k.size() != 5) {
    node.Fail("a list of " + std::to_string(k.size()), "[k1, k2, p1, p2, k3]");
  }
  model.k1 = k[0], model.k2 = k[1], model.p1 = k[2], model.p2 = k[3];
  model.k3 = k.size() == 5 ? k[4] : 0;
}

RigCamera ReadCamera(const YamlReader& node) {
  // Taken as a fixed camera, one that pans would measure nonsense without a word.
  if (const auto moving = node.Optional("moving")) {
    moving->Fail("a camera that moves", "fixed cameras: this version cannot follow a moving one");
  }
  node.RequireKeys(
      {"name", "source", "image_size_px", "intrinsics", "distortion", "cam_from_world", "noise"});
  RigCamera camera;
  camera.name = node.Required("name").Name();
  if (const auto source = node.Optional("source")) {
    ReadCameraSource(*source, camera.source, camera.source_settings);
  }
  const YamlReader size = node.Required("image_size_px");
  if (size.Numbers(2).size() == 2) {
    constexpr int kLargest = 65536;
    camera.width_px = size.Items()[0].Integer(1, kLargest);
    camera.height_px = size.Items()[1].Integer(1, kLargest);
  }
  const YamlReader intrinsics = node.Required("intrinsics");
  intrinsics.RequireKeys({"fx_px", "fy_px", "cx_px", "cy_px"});
  camera.model.fx_px = intrinsics.Required("fx_px").Positive();
  camera.model.fy_px = intrinsics.Required("fy_px").Positive();
  camera.model.cx_px = intrinsics.Required("cx_px").Number();
  camera.model.cy_px = intrinsics.Required("cy_px").Number();
  if (const auto distortion = node.Optional("distortion"))
    ReadDistortion(*distortion, camera.model);
  camera.cam_from_world = ReadPose(node.Required("cam_from_world"));
  if (const auto noise = node.Optional("noise")) camera.noise = ReadNoise(*noise);
  return camera;
}

}  // namespace

Rig ReadOwnRig(const YamlReader& root) {
  const std::string format = root.Required("format").Text();
  if (format != "stereomotion-rig/1") {
    root.Required("format").Fail("'" + format + "'", "'stereomotion-rig/1'");
  }
  root.RequireKeys({"format", "cameras", "noise", "covariance", "calibration"});
  Rig rig;
  for (const YamlReader& node : root.Required("cameras").Items()) {
    rig.cameras.push_back(ReadCamera(node));
    for (std::size_t i = 0; i + 1 < rig.cameras.size(); ++i) {
      if (rig.cameras[i].name == rig.cameras.back().name) {
        node.Required("name").Fail("'" + rig.cameras[i].name + "' twice", "a name of its own");
      }
    }
  }
  if (const auto noise = root.Optional("noise")) ReadNoises(*noise, rig);
  if (const auto covariance = root.Optional("covariance")) {
    rig.covariance = ReadRigCovariance(*covariance, rig);
  }
  return rig;
}

}  // namespace stereomotion
