#pragma once

#include <Eigen/Core>
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
};

struct VelocityOptions {
  double max_gap_s = 0.1;  ///< shorter gaps are filled and flagged, longer ones end the window
  int max_half_window = 25;
};

/// Estimates angular and linear velocity and acceleration of every frame by a local polynomial fit
/// on SO(3) × R³ in the poses' covariances; window and degree are chosen by evidence.
std::vector<BodyVelocity> EstimateVelocities(const PoseSeries& series,
                                             const VelocityOptions& options = {});

/// Moves the reference from the body's origin to another body point: v and a of that point.
BodyVelocity VelocityOfPoint(const BodyVelocity& origin, const Rigid3& world_from_body,
                             const Eigen::Vector3d& point_in_body_mm);

}  // namespace stereomotion
