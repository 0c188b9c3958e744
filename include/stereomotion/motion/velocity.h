#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "stereomotion/motion/motion_data.h"

namespace stereomotion {

/// Says where a motion sample comes from (words: docs/formats.md).
enum class MotionStatus {
  kOk,
  kFilled,  ///< inside a gap that was short enough to be filled
  kGap,     ///< nothing is said
};

/// Holds how a body moves at one time: of the body frame's origin, in world axes.
struct BodyVelocity {
  MotionStatus status = MotionStatus::kGap;
  Eigen::Vector3d omega_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_mm_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d alpha_rad_s2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d acceleration_mm_s2 = Eigen::Vector3d::Zero();
  /// Random covariance of (ω, v, α, a); the window's bias, as far as evidence bounds it, included.
  Eigen::Matrix<double, 12, 12> covariance = Eigen::Matrix<double, 12, 12>::Zero();
  bool has_acceleration = false;
  int window = 0;  ///< poses used
  int degree = 0;  ///< of the polynomial: 1, 2, 4 or 6
  /// Rods alone in the window: unit vector about which the body's turning is not seen. There ω and
  /// α are given as zero and their variance is infinite (zero is written).
  std::optional<Eigen::Vector3d> open_axis_in_world;
};

struct VelocityOptions {
  double max_gap_s = 0.1;  ///< shorter gaps are filled and flagged, longer ones end the window
  int max_half_window = 25;
};

/// Estimates angular and linear velocity and acceleration of every frame by a local polynomial fit
/// on SO(3) × R³ in the poses' covariances; window and degree are chosen by evidence.
std::vector<BodyVelocity> EstimateVelocities(const PoseSeries& series,
                                             const VelocityOptions& options = {});

/// Moves the reference from the body's origin to another body point: v and a of that point. The
/// lever R · point is itself as uncertain as the pose: ω × (δθ × lever) is no smaller than the
/// noise of ω × lever where windows are long. `rotation_covariance_rad2` (of the pose's δθ) adds
/// it; it is taken as independent of ω, as it is in a symmetrical window.
BodyVelocity VelocityOfPoint(
    const BodyVelocity& origin, const Rigid3& world_from_body,
    const Eigen::Vector3d& point_in_body_mm,
    const Eigen::Matrix3d& rotation_covariance_rad2 = Eigen::Matrix3d::Zero());

}  // namespace stereomotion
