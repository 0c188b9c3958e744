#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "stereomotion/camera/rig.h"
#include "stereomotion/core/body.h"
#include "stereomotion/core/units.h"
#include "stereomotion/geometry/rigid3.h"

namespace stereomotion {

/// Holds one pose of a series, or the gap where there is none.
struct PoseSample {
  std::int64_t frame = -1;
  std::int64_t timestamp_ns = 0;
  bool measured = false;  ///< false: a gap; nothing below counts
  Rigid3 world_from_body;
  /// Random covariance of the left perturbation (δθ, δt) in world axes [rad, mm]; zero about
  /// `free_axis_in_world` (there the variance is infinite).
  Matrix6d covariance = Matrix6d::Zero();
  std::optional<Vector6d> calibration_u;  ///< standard uncertainty of the common part
  std::optional<Eigen::Vector3d> free_axis_in_world;
};

/// Holds poses in order of time, which ascends strictly.
using PoseSeries = std::vector<PoseSample>;

/// Tells the time of a sample in seconds after the series' first one.
inline double SecondsAfterFirst(const PoseSeries& series, std::size_t i) {
  return SecondsBetween(series.front().timestamp_ns, series[i].timestamp_ns);
}

/// Holds the projection of a ball's centre in one image (perspective bias of the sphere removed).
struct ImagePoint {
  int camera = 0;  ///< 0 left, 1 right
  int ball = 0;    ///< index into `MotionData::balls_in_body_mm`
  Eigen::Vector2d center_px = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance_px2 = Eigen::Matrix2d::Identity();
};

/// Holds a measured place of a ball or marker.
struct SpacePoint {
  int ball = 0;
  Eigen::Vector3d p_in_world_mm = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_mm2 = Eigen::Matrix3d::Identity();
};

/// Holds what was observed in one frame. With neither image nor space points the pose itself is the
/// observation, with its covariance; otherwise it is where the estimation starts.
struct MotionFrame {
  PoseSample pose;
  std::vector<ImagePoint> image_points;
  std::vector<SpacePoint> space_points;
};

/// Holds all that a body's motion is estimated from.
struct MotionData {
  Rig rig;  ///< of image points; no cameras: none
  int left_camera = 0, right_camera = 1;
  std::vector<Eigen::Vector3d> balls_in_body_mm;  ///< body frame; may be empty with poses alone
  /// Covariance of all balls' coordinates (3M×3M, a COMMON part); empty: taken as exact.
  Eigen::MatrixXd structure_covariance_mm2;
  /// Where the body's geometry is not known, `balls_in_body_mm` only starts its estimation (for
  /// image and space points; gauge: the balls' mean and, to first order, their turn stay).
  bool structure_known = true;
  std::vector<MotionFrame> frames;  ///< gaps included
};

/// Collects the poses of the frames.
PoseSeries PosesOf(const MotionData& data);

}  // namespace stereomotion
