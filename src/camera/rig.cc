#include "stereomotion/camera/rig.h"

#include <array>
#include <stdexcept>

#include "stereomotion/geometry/so3.h"

namespace stereomotion {

std::string RigParameterName(const Rig& rig, const RigParameter& parameter) {
  static constexpr std::array<const char*, RigParameter::kPerCamera> kNames = {
      "fx_px", "fy_px",  "cx_px",  "cy_px",  "k1",    "k2",    "p1",   "p2",
      "k3",    "rx_rad", "ry_rad", "rz_rad", "tx_mm", "ty_mm", "tz_mm"};
  if (parameter.camera < 0 || parameter.camera >= static_cast<int>(rig.cameras.size()) ||
      parameter.index < 0 || parameter.index >= RigParameter::kPerCamera) {
    throw std::invalid_argument("RigParameterName: the rig has no such parameter");
  }
  return rig.cameras[parameter.camera].name + "." + kNames[parameter.index];
}

std::optional<Eigen::Vector2d> ProjectWorldPoint(
    const RigCamera& camera, const Eigen::Vector3d& p_in_world_mm,
    Eigen::Matrix<double, 2, 3>* d_point,
    Eigen::Matrix<double, 2, RigParameter::kPerCamera>* d_parameters) {
  const Eigen::Matrix3d rotation = camera.cam_from_world.rotation.toRotationMatrix();
  const Eigen::Vector3d rotated_mm = rotation * p_in_world_mm;
  const Eigen::Vector3d p_in_cam_mm = rotated_mm + camera.cam_from_world.translation_mm;

  if (d_point == nullptr && d_parameters == nullptr) return camera.model.Project(p_in_cam_mm);
  Eigen::Matrix<double, 2, 3> d_p_in_cam;
  Eigen::Matrix<double, 2, CameraModel::kNumParameters> d_model;
  const auto pixel_px =
      camera.model.Project(p_in_cam_mm, &d_p_in_cam, d_parameters != nullptr ? &d_model : nullptr);
  if (!pixel_px) return std::nullopt;
  if (d_point != nullptr) *d_point = d_p_in_cam * rotation;
  if (d_parameters != nullptr) {
    // Exp(δθ) R p + t + δt: the rotation's perturbation acts on R p, not on R p + t.
    *d_parameters << d_model, -d_p_in_cam * Hat(rotated_mm), d_p_in_cam;
  }
  return pixel_px;
}

}  // namespace stereomotion
