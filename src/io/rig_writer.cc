#include "stereomotion/io/rig_writer.h"

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <initializer_list>
#include <stdexcept>
#include <utility>

#include "camera_source.h"
#include "covariance_yaml.h"
#include "number_text.h"
#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

using Fields = std::initializer_list<std::pair<const char*, double>>;

std::string Map(const Fields& fields) {
  std::string text = "{";
  for (const auto& [key, value] : fields) {
    text += fmt::format("{}{}: {}", text.size() > 1 ? ", " : "", key, NumberText(value));
  }
  return text + "}";
}

// A plain word where YAML takes it for one, else quoted: `cam0`, "1e3", "null".
std::string Word(const std::string& text) {
  bool plain = text.rfind("cam", 0) == 0;
  for (const char c : text) {
    plain = plain && (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.');
  }
  return plain ? text : QuotedText(text);
}

std::string CameraText(const RigCamera& camera) {
  if (camera.width_px < 1 || camera.height_px < 1) {
    throw std::invalid_argument("RigYaml: camera " + camera.name + " has no image size");
  }
  const CameraModel& m = camera.model;
  const Eigen::Quaterniond q = WithPositiveW(camera.cam_from_world.rotation);
  const Eigen::Vector3d& t_mm = camera.cam_from_world.translation_mm;
  std::string text = "  - name: " + Word(camera.name) + "\n";
  if (!camera.source.empty()) {
    text += "    source: " + CameraSourceText(camera.source, camera.source_settings) + "\n";
  }
  text += fmt::format("    image_size_px: [{}, {}]\n", camera.width_px, camera.height_px);
  text += "    intrinsics: " +
          Map({{"fx_px", m.fx_px}, {"fy_px", m.fy_px}, {"cx_px", m.cx_px}, {"cy_px", m.cy_px}}) +
          "\n";
  text +=
      fmt::format("    distortion: [{}, {}, {}, {}, {}]  # k1, k2, p1, p2, k3\n", NumberText(m.k1),
                  NumberText(m.k2), NumberText(m.p1), NumberText(m.p2), NumberText(m.k3));
  text +=
      "    cam_from_world: " + Map({{"qw", q.w()}, {"qx", q.x()}, {"qy", q.y()}, {"qz", q.z()}});
  text.pop_back();
  text += ",\n                     " +
          Map({{"tx_mm", t_mm.x()}, {"ty_mm", t_mm.y()}, {"tz_mm", t_mm.z()}}).substr(1) + "\n";
  return text;
}

std::string NoiseText(const Rig& rig) {
  std::string text;
  for (const RigCamera& camera : rig.cameras) {
    if (!camera.noise) continue;
    const SensorNoise& noise = *camera.noise;
    text += "  " + Word(camera.name) + ": " +
            Map({{"gain_e_per_dn", noise.gain_e_per_dn},
                 {"read_e", noise.read_e},
                 {"black_dn", noise.black_dn},
                 {"saturation_dn", noise.saturation_dn}}) +
            "\n";
  }
  return text.empty() ? "" : "noise:\n" + text;
}

std::string CovarianceText(const Rig& rig) {
  if (!rig.covariance || rig.covariance->parameters.empty()) return "";
  std::vector<std::string> names;
  for (const RigParameter& parameter : rig.covariance->parameters) {
    names.push_back(Word(RigParameterName(rig, parameter)));
  }
  return CovarianceYaml(names, rig.covariance->matrix);
}

std::string RecordText(const CalibrationRecord& record) {
  std::string text;
  const auto add = [&](const char* key, const std::string& value) {
    if (!value.empty()) text += fmt::format("  {}: {}\n", key, QuotedText(value));
  };
  const auto add_number = [&](const char* key, const std::optional<double>& value) {
    if (value) text += fmt::format("  {}: {}\n", key, NumberText(*value));
  };
  add("date", record.date);
  add("program", record.program);
  add("source", record.source);
  add("target", record.target);
  if (record.views) text += fmt::format("  views: {}\n", *record.views);
  add_number("rms_px", record.rms_px);
  add_number("chi2_dof", record.chi2_dof);
  add_number("check_points_rms_mm", record.check_points_rms_mm);
  add_number("cross_validation_rms_mm", record.cross_validation_rms_mm);
  return text.empty() ? "" : "calibration:\n" + text;
}

}  // namespace

std::string RigYaml(const Rig& rig, const CalibrationRecord& record) {
  std::string text = "format: stereomotion-rig/1\ncameras:\n";
  for (const RigCamera& camera : rig.cameras) text += CameraText(camera);
  return text + NoiseText(rig) + CovarianceText(rig) + RecordText(record);
}

}  // namespace stereomotion
