#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "stereomotion/geometry/rigid3.h"

namespace stereomotion {

/// Holds a placement of the body and the time of it, counted from the middle one.
struct TimedPlacement {
  double time_s = 0;
  Rigid3 world_from_body;
};

/// Holds how a body moves around time 0: constant linear and angular acceleration.
struct LocalMotion {
  Rigid3 world_from_body;  ///< at time 0
  Eigen::Vector3d pivot_in_body_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_mm_s = Eigen::Vector3d::Zero();  ///< of the pivot
  Eigen::Vector3d acceleration_mm_s2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_acceleration_rad_s2 = Eigen::Vector3d::Zero();
  /// Both accelerations are weighted sums of the placements. Weight of the middle one, and the sum
  /// of the other weights' squares: for their uncertainty [1/s², 1/s⁴].
  double middle_weight_s_2 = 0;
  double other_weights2_s_4 = 0;

  /// Finds where a point of the body is at `time_s`, in the world.
  [[nodiscard]] Eigen::Vector3d At(const Eigen::Vector3d& p_in_body_mm, double time_s) const;
};

/// Fits a parabola to the way and the turn of three or more placements (least squares), among them
/// the middle one at time 0. Nothing with fewer, or where they lie too far apart (a turn of over
/// 1 rad) for a parabola.
std::optional<LocalMotion> FitLocalMotion(const std::vector<TimedPlacement>& placements,
                                          const Eigen::Vector3d& pivot_in_body_mm);

}  // namespace stereomotion
