#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "rig_formats.h"
#include "stereomotion/core/user_error.h"
#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

// Bounds of what can be meant, wide enough for any rig that measures a body of millimetres to
// metres.
constexpr double kShortestBaselineMm = 10;
constexpr double kLongestBaselineMm = 200'000;
constexpr double kShortestFocalLength = 0.1;  // in image widths: a field of view of 157°
constexpr double kLongestFocalLength = 100;   // in image widths: 0.6°

void CheckCamera(const std::string& place, const RigCamera& camera) {
  const CameraModel& model = camera.model;
  for (const auto& [key, f_px] : {std::pair{"fx_px", model.fx_px}, {"fy_px", model.fy_px}}) {
    const double widths = f_px / camera.width_px;
    if (widths < kShortestFocalLength || widths > kLongestFocalLength) {
      throw UserError(
          fmt::format("{}: found {} {} with images {} px wide, expected the focal length "
                      "in pixels (not in mm)",
                      place, key, f_px, camera.width_px));
    }
  }
  const auto outside = [](double c_px, int size_px) {
    return c_px < -0.5 * size_px || c_px > 1.5 * size_px;
  };
  if (outside(model.cx_px, camera.width_px) || outside(model.cy_px, camera.height_px)) {
    throw UserError(
        fmt::format("{}: found the principal point ({}, {}) with image_size_px [{}, {}], expected "
                    "it in or near "
                    "the image (is the image size that of the calibration, width first?)",
                    place, model.cx_px, model.cy_px, camera.width_px, camera.height_px));
  }
}

}  // namespace

void CheckRig(const std::filesystem::path& file, const Rig& rig) {
  if (rig.cameras.size() < 2) {
    throw UserError(fmt::format("{}: found {} camera(s), expected 2 or more", file.string(),
                                rig.cameras.size()));
  }
  for (const RigCamera& camera : rig.cameras) {
    CheckCamera(file.string() + ": camera " + camera.name, camera);
  }
  for (std::size_t i = 1; i < rig.cameras.size(); ++i) {
    const Rigid3 first = rig.cameras[0].cam_from_world.Inverse();
    const Rigid3 other = rig.cameras[i].cam_from_world.Inverse();
    const double baseline_mm = (first.translation_mm - other.translation_mm).norm();
    if (baseline_mm < kShortestBaselineMm || baseline_mm > kLongestBaselineMm) {
      throw UserError(fmt::format(
          "{}: cameras {} and {} stand {:.4g} mm apart, expected {} to {} mm{}", file.string(),
          rig.cameras[0].name, rig.cameras[i].name, baseline_mm, kShortestBaselineMm,
          kLongestBaselineMm,
          baseline_mm < kShortestBaselineMm ? " (are the translations in metres? They are in mm)"
                                            : " (are the translations in mm?)"));
    }
  }
}

Rigid3 MakeRigid(const std::string& place, const Eigen::Matrix3d& rotation,
                 const Eigen::Vector3d& translation_mm) {
  const double deviation = (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm();
  constexpr double kTolerance = 1e-3;
  if (!(deviation < kTolerance) || rotation.determinant() < 0 || !translation_mm.allFinite()) {
    throw UserError(
        fmt::format("{}: found a matrix {:.3g} from orthonormal (determinant {:.3g}), "
                    "expected a rotation",
                    place, deviation, rotation.determinant()));
  }
  return {WithPositiveW(Eigen::Quaterniond(rotation).normalized()), translation_mm};
}

}  // namespace stereomotion
