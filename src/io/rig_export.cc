#include "stereomotion/io/rig_export.h"

#include <fmt/format.h>

#include <algorithm>

#include "export_formats.h"
#include "stereomotion/core/user_error.h"

namespace stereomotion {
namespace {

const char* FormatName(RigFormat format) {
  switch (format) {
    case RigFormat::kOpenCvYaml:
    case RigFormat::kOpenCvXml:
      return "OpenCV's format";
    case RigFormat::kKalibr:
      return "Kalibr's format";
    case RigFormat::kAnipose:
      return "anipose's format";
    case RigFormat::kRos:
      return "ROS camera_info";
    case RigFormat::kDlt:
      return "DLT coefficients";
  }
  return "";
}

// Leaves the coefficients that a format holds.
CameraModel Reduced(CameraModel model, RigFormat format) {
  if (format == RigFormat::kKalibr || format == RigFormat::kDlt) model.k3 = 0;
  if (format == RigFormat::kDlt) model.k1 = model.k2 = model.p1 = model.p2 = 0;
  return model;
}

// Finds how far the image moves at most where coefficients are left out.
double LargestShiftPx(const RigCamera& camera, const CameraModel& reduced) {
  constexpr int kSteps = 16;
  const CameraModel& full = camera.model;
  double largest_px = 0;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      const Eigen::Vector2d normalized(
          (camera.width_px * i / double{kSteps} - full.cx_px) / full.fx_px,
          (camera.height_px * j / double{kSteps} - full.cy_px) / full.fy_px);
      const Eigen::Vector2d shift = full.Distort(normalized) - reduced.Distort(normalized);
      largest_px = std::max(largest_px, std::hypot(shift.x() * full.fx_px, shift.y() * full.fy_px));
    }
  }
  return largest_px;
}

bool IsSame(const CameraModel& a, const CameraModel& b) {
  return a.k1 == b.k1 && a.k2 == b.k2 && a.p1 == b.p1 && a.p2 == b.p2 && a.k3 == b.k3;
}

Rig DropDistortion(const Rig& rig, RigFormat format, bool allowed,
                   std::vector<std::string>& notes) {
  Rig reduced = rig;
  for (RigCamera& camera : reduced.cameras) {
    const CameraModel model = Reduced(camera.model, format);
    if (IsSame(model, camera.model)) continue;
    const std::string lost = fmt::format(
        "{}: {} of camera {}, which {:.2g} px in its image depend on", FormatName(format),
        format == RigFormat::kDlt ? "the distortion" : "the coefficient k3", camera.name,
        LargestShiftPx(camera, model));
    if (!allowed) {
      throw UserError(lost + ", cannot be expressed; give --drop-distortion to leave it out, or " +
                      (format == RigFormat::kDlt ? "undistort the image points first"
                                                 : "calibrate with free: [...] without k3"));
    }
    notes.push_back(lost + ", is left out");
    camera.model = model;
  }
  return reduced;
}

void RequirePair(const Rig& rig, RigFormat format) {
  if (format == RigFormat::kKalibr || format == RigFormat::kAnipose || format == RigFormat::kDlt ||
      rig.cameras.size() == 2) {
    return;
  }
  throw UserError(fmt::format("{} holds two cameras, found {}; kalibr, anipose and dlt take more",
                              FormatName(format), rig.cameras.size()));
}

bool IsAtWorld(const Rigid3& cam_from_world) {
  constexpr double kRounding = 1e-12;
  return cam_from_world.rotation.vec().norm() < kRounding &&
         cam_from_world.translation_mm.norm() < kRounding;
}

void NoteLosses(const Rig& rig, RigFormat format, std::vector<std::string>& notes) {
  const std::string name = FormatName(format);
  if (rig.covariance) notes.push_back(name + " holds no covariance; it is left out");
  const bool has_world = format == RigFormat::kAnipose || format == RigFormat::kDlt;
  if (!has_world && !IsAtWorld(rig.cameras.front().cam_from_world)) {
    notes.push_back(name + " holds no world; it becomes the frame of " + rig.cameras[0].name);
  }
}

std::vector<ExportedFile> Files(const Rig& rig, RigFormat format, DltPixels pixels) {
  switch (format) {
    case RigFormat::kOpenCvYaml:
    case RigFormat::kOpenCvXml:
      return {{"", OpenCvText(rig, format == RigFormat::kOpenCvXml)}};
    case RigFormat::kKalibr:
      return {{"", KalibrText(rig)}};
    case RigFormat::kAnipose:
      return {{"", AniposeText(rig)}};
    case RigFormat::kRos: {
      const auto texts = RosTexts(rig);
      return {{"left.yaml", texts[0]}, {"right.yaml", texts[1]}};
    }
    case RigFormat::kDlt:
      return {{"", DltText(rig, pixels)}};
  }
  throw std::invalid_argument("ExportRig: no such format");
}

}  // namespace

Eigen::Matrix3d CameraMatrix(const CameraModel& model) {
  Eigen::Matrix3d matrix;
  matrix << model.fx_px, 0, model.cx_px, 0, model.fy_px, model.cy_px, 0, 0, 1;
  return matrix;
}

RigExport ExportRig(const Rig& rig, RigFormat format, const ExportOptions& options) {
  if (rig.cameras.empty()) throw std::invalid_argument("ExportRig: a rig without cameras");
  RequirePair(rig, format);
  RigExport result;
  NoteLosses(rig, format, result.notes);
  const Rig reduced = DropDistortion(rig, format, options.drop_distortion, result.notes);
  result.files = Files(reduced, format, options.dlt_pixels);
  return result;
}

}  // namespace stereomotion
