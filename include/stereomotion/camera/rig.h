#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "stereomotion/camera/camera.h"
#include "stereomotion/core/camera_settings.h"
#include "stereomotion/core/sensor_noise.h"
#include "stereomotion/geometry/rigid3.h"

namespace stereomotion {

/// Holds one calibrated camera of a rig.
struct RigCamera {
  std::string name;
  std::string source;              ///< where live images come from; may be empty
  CameraSettings source_settings;  ///< how that camera is set
  int width_px = 0;
  int height_px = 0;
  CameraModel model;
  Rigid3 cam_from_world;
  std::optional<SensorNoise> noise;
};

/// Names one estimated parameter of a rig, in the order of `RigCovariance`.
struct RigParameter {
  /// 0–8: fx fy cx cy k1 k2 p1 p2 k3; 9–11: rotation (left perturbation of cam_from_world) [rad];
  /// 12–14: translation [mm].
  static constexpr int kPerCamera = 15;
  int camera = 0;
  int index = 0;
};

/// Holds the covariance of all estimated parameters of a rig together.
struct RigCovariance {
  std::vector<RigParameter> parameters;
  Eigen::MatrixXd matrix;  ///< N×N, N = parameters.size(), units by parameter
};

/// Holds a calibrated camera pair (or more cameras; `track` uses two).
struct Rig {
  std::vector<RigCamera> cameras;
  std::optional<RigCovariance> covariance;
};

/// Spells a parameter as rig.yaml does: `cam0.fx_px`, `cam1.rx_rad`, ….
std::string RigParameterName(const Rig& rig, const RigParameter& parameter);

/// Projects a world point [mm] through one camera of the rig to its image [px]; nothing where the
/// camera cannot see it. `d_point` receives ∂(u, v)/∂(world point) [px/mm], `d_parameters`
/// ∂(u, v)/∂ all `RigParameter::kPerCamera` parameters of that camera.
std::optional<Eigen::Vector2d> ProjectWorldPoint(
    const RigCamera& camera, const Eigen::Vector3d& p_in_world_mm,
    Eigen::Matrix<double, 2, 3>* d_point = nullptr,
    Eigen::Matrix<double, 2, RigParameter::kPerCamera>* d_parameters = nullptr);

}  // namespace stereomotion
