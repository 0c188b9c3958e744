#include "rig_formats.h"

namespace stereomotion {
namespace {

constexpr double kMmPerMetre = 1000;

// `T_cn_cnm1` maps the camera before to this one; Kalibr's lengths are metres.
Rigid3 ReadStep(const YamlReader& node) {
  Eigen::Matrix3d rotation;
  Eigen::Vector3d translation_mm;
  const auto rows = node.Items();
  if (rows.size() != 4) node.Fail("a list of " + std::to_string(rows.size()), "a 4 × 4 matrix");
  for (int i = 0; i < 3; ++i) {
    const std::vector<double> row = rows[static_cast<std::size_t>(i)].Numbers(4);
    rotation.row(i) << row[0], row[1], row[2];
    translation_mm[i] = row[3] * kMmPerMetre;
  }
  return MakeRigid(node.Place(), rotation, translation_mm);
}

RigCamera ReadCamera(const YamlReader& node, const std::string& name) {
  RigCamera camera;
  camera.name = name;
  const YamlReader kind = node.Required("camera_model");
  if (kind.Text() != "pinhole") kind.Fail("'" + kind.Text() + "'", "'pinhole'");
  const YamlReader distortion = node.Required("distortion_model");
  if (distortion.Text() != "radtan" && distortion.Text() != "none") {
    distortion.Fail("'" + distortion.Text() + "'", "'radtan' or 'none'");
  }
  const std::vector<double> f = node.Required("intrinsics").Numbers(4);
  const bool distorts = distortion.Text() == "radtan";
  const auto k = distorts ? node.Required("distortion_coeffs").Numbers(4) : std::vector<double>(4);
  camera.model = {f[0], f[1], f[2], f[3], k[0], k[1], k[2], k[3], 0};
  const auto size = node.Required("resolution").Items();
  if (size.size() != 2) node.Required("resolution").Fail("not two numbers", "[width, height]");
  constexpr int kLargest = 65536;
  camera.width_px = size[0].Integer(1, kLargest);
  camera.height_px = size[1].Integer(1, kLargest);
  return camera;
}

}  // namespace

// The world is the first camera's frame. Kalibr writes many keys; those that are not of the camera
// model (topics, overlaps, IMU) are none of ours.
Rig ReadKalibrRig(const YamlReader& root) {
  Rig rig;
  for (int i = 0; root.Has("cam" + std::to_string(i)); ++i) {
    const std::string name = "cam" + std::to_string(i);
    const YamlReader node = root.Required(name);
    RigCamera camera = ReadCamera(node, name);
    if (i > 0) {
      camera.cam_from_world =
          ReadStep(node.Required("T_cn_cnm1")) * rig.cameras.back().cam_from_world;
    }
    rig.cameras.push_back(camera);
  }
  return rig;
}

}  // namespace stereomotion
