#include "local_motion.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

/// The middle placement, at time 0.
const TimedPlacement* Middle(const std::vector<TimedPlacement>& placements) {
  const auto middle =
      std::find_if(placements.begin(), placements.end(),
                   [](const TimedPlacement& placement) { return placement.time_s == 0; });
  return middle == placements.end() ? nullptr : &*middle;
}

/// Turn [rad] and way of the pivot [mm] from the middle placement to each; nothing where they turn
/// too far.
std::optional<Eigen::Matrix<double, Eigen::Dynamic, 6>> WaysFrom(
    const TimedPlacement& middle, const std::vector<TimedPlacement>& placements,
    const Eigen::Vector3d& pivot_in_body_mm) {
  // Where the turn is larger, its fourth derivative costs a tenth of the acceleration.
  constexpr double kLargestTurn_rad = 1;
  Eigen::Matrix<double, Eigen::Dynamic, 6> ways(static_cast<Eigen::Index>(placements.size()), 6);
  for (std::size_t i = 0; i < placements.size(); ++i) {
    const Rigid3& to = placements[i].world_from_body;
    const Rigid3& from = middle.world_from_body;
    const Eigen::Vector3d turn_rad = LogSO3(to.rotation * from.rotation.conjugate());
    if (turn_rad.norm() > kLargestTurn_rad) return std::nullopt;
    const Eigen::Vector3d way_mm = to * pivot_in_body_mm - from * pivot_in_body_mm;
    ways.row(static_cast<Eigen::Index>(i)) << turn_rad.transpose(), way_mm.transpose();
  }
  return ways;
}

/// The least-squares inverse that makes of values at the placements' times a value, a rate and an
/// acceleration.
Eigen::Matrix3Xd ParabolaSolver(const std::vector<TimedPlacement>& placements) {
  const auto n = static_cast<Eigen::Index>(placements.size());
  double scale_s = 0;  // so that the columns compare
  for (const TimedPlacement& one : placements) scale_s = std::max(scale_s, std::abs(one.time_s));
  Eigen::MatrixX3d powers(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double time = placements[static_cast<std::size_t>(i)].time_s / scale_s;
    powers.row(i) << 1, time, 0.5 * time * time;
  }
  Eigen::Matrix3Xd solver = powers.colPivHouseholderQr().solve(Eigen::MatrixXd::Identity(n, n));
  solver.row(1) /= scale_s;
  solver.row(2) /= scale_s * scale_s;
  return solver;
}

}  // namespace

Eigen::Vector3d LocalMotion::At(const Eigen::Vector3d& p_in_body_mm, double time_s) const {
  const double half_square_s2 = 0.5 * time_s * time_s;
  const Eigen::Vector3d turn_rad =
      time_s * rate_rad_s + half_square_s2 * angular_acceleration_rad_s2;
  const Eigen::Vector3d arm_mm = world_from_body.rotation * (p_in_body_mm - pivot_in_body_mm);
  return world_from_body * pivot_in_body_mm + time_s * velocity_mm_s +
         half_square_s2 * acceleration_mm_s2 + ExpSO3(turn_rad) * arm_mm;
}

std::optional<LocalMotion> FitLocalMotion(const std::vector<TimedPlacement>& placements,
                                          const Eigen::Vector3d& pivot_in_body_mm) {
  constexpr std::size_t kParabola = 3;  // coefficients
  const TimedPlacement* middle = Middle(placements);
  if (middle == nullptr || placements.size() < kParabola) return std::nullopt;
  const auto ways = WaysFrom(*middle, placements, pivot_in_body_mm);
  if (!ways) return std::nullopt;
  const Eigen::Matrix3Xd solver = ParabolaSolver(placements);
  const Eigen::Matrix<double, 3, 6> fit = solver * *ways;
  LocalMotion motion;
  motion.world_from_body = middle->world_from_body;
  motion.pivot_in_body_mm = pivot_in_body_mm;
  motion.rate_rad_s = fit.block<1, 3>(1, 0).transpose();
  motion.velocity_mm_s = fit.block<1, 3>(1, 3).transpose();
  motion.angular_acceleration_rad_s2 = fit.block<1, 3>(2, 0).transpose();
  motion.acceleration_mm_s2 = fit.block<1, 3>(2, 3).transpose();
  motion.middle_weight_s_2 = solver(2, middle - placements.data());
  motion.other_weights2_s_4 =
      solver.row(2).squaredNorm() - motion.middle_weight_s_2 * motion.middle_weight_s_2;
  return motion;
}

}  // namespace stereomotion
