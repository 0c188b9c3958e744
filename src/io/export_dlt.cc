#include <vector>

#include "export_formats.h"
#include "number_text.h"
#include "stereomotion/core/user_error.h"

namespace stereomotion {
namespace {

using Matrix34d = Eigen::Matrix<double, 3, 4>;

// The coefficients are scaled so that the twelfth is 1; it is the origin's depth.
Matrix34d Coefficients(const RigCamera& camera, DltPixels pixels) {
  Matrix34d cam_from_world;
  cam_from_world << camera.cam_from_world.rotation.toRotationMatrix(),
      camera.cam_from_world.translation_mm;
  constexpr double kSmallestDepthMm = 1e-3;
  const double depth_mm = cam_from_world(2, 3);
  if (!(depth_mm > kSmallestDepthMm)) {
    throw UserError(
        "DLT coefficients need a world whose origin lies before every camera; it lies "
        "in the plane of camera " +
        camera.name + " or behind it");
  }
  return DltFromPixel(pixels, camera.height_px) * CameraMatrix(camera.model) * cam_from_world /
         depth_mm;
}

}  // namespace

Eigen::Matrix3d DltFromPixel(DltPixels pixels, int height_px) {
  Eigen::Matrix3d map = Eigen::Matrix3d::Identity();
  if (pixels == DltPixels::kZeroBased) return map;
  map(0, 2) = map(1, 2) = 1;
  if (pixels == DltPixels::kDltdv5) {
    map(1, 1) = -1;
    map(1, 2) = height_px - 1;
  }
  return map;
}

std::string DltText(const Rig& rig, DltPixels pixels) {
  std::vector<Matrix34d> cameras;
  for (const RigCamera& camera : rig.cameras) cameras.push_back(Coefficients(camera, pixels));
  constexpr int kNumCoefficients = 11;
  std::string text;
  for (int i = 0; i < kNumCoefficients; ++i) {
    for (std::size_t camera = 0; camera < cameras.size(); ++camera) {
      text += (camera > 0 ? "," : "") + NumberText(cameras[camera](i / 4, i % 4));
    }
    text += '\n';
  }
  return text;
}

}  // namespace stereomotion
