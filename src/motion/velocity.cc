#include "stereomotion/motion/velocity.h"

#include <Eigen/LU>
#include <algorithm>
#include <stdexcept>
#include <string>

#include "motion/filter_segments.h"
#include "motion/local_polynomial.h"
#include "motion/path_roughness.h"
#include "motion/velocity_window.h"
#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

using Matrix12 = Eigen::Matrix<double, 12, 12>;

/// Pilot fits reach this much farther than the windows whose bias they bound.
constexpr int kPilotReach = 2;
/// Gives a rod's roll, which is not seen but smooth by construction, a weight like the rest.
Matrix6d InformationOf(const PoseSample& pose) {
  Matrix6d covariance = pose.covariance;
  if (pose.free_axis_in_world) {
    const Eigen::Vector3d& f = *pose.free_axis_in_world;
    covariance.topLeftCorner<3, 3>() +=
        covariance.topLeftCorner<3, 3>().trace() / 2 * f * f.transpose();
  }
  return covariance.inverse();
}

/// Splits at long gaps and where a rod alone takes over from the whole body, or back.
std::vector<PoseStretch> StretchesOf(const PoseSeries& series, const VelocityOptions& options) {
  std::vector<PoseStretch> stretches;
  const double unit_s = std::max(MedianPeriodS(series), 1e-9) * options.max_half_window;
  for (const FilterSegment& segment : SplitAtGaps(series, options.max_gap_s)) {
    for (std::size_t k = 0; k < segment.measured.size(); ++k) {
      const PoseSample& pose = series[segment.measured[k]];
      const bool same = k > 0 && pose.free_axis_in_world.has_value() ==
                                     series[segment.measured[k - 1]].free_axis_in_world.has_value();
      if (!same) {
        stretches.emplace_back();
        stretches.back().unit_s = unit_s;
      }
      stretches.back().indices.push_back(segment.measured[k]);
      stretches.back().times_s.push_back(segment.times_s[k]);
      stretches.back().poses.push_back(pose.world_from_body);
      stretches.back().information.push_back(InformationOf(pose));
    }
  }
  return stretches;
}

/// Takes out what one rod cannot tell: the turning about itself.
void OpenAbout(const Eigen::Vector3d& axis, BodyVelocity& velocity) {
  velocity.open_axis_in_world = axis;
  Matrix12 seen = Matrix12::Identity();
  seen.topLeftCorner<3, 3>() -= axis * axis.transpose();
  seen.block<3, 3>(6, 6) -= axis * axis.transpose();
  velocity.omega_rad_s = seen.topLeftCorner<3, 3>() * velocity.omega_rad_s;
  velocity.alpha_rad_s2 = seen.topLeftCorner<3, 3>() * velocity.alpha_rad_s2;
  velocity.covariance = (seen * velocity.covariance * seen).eval();
}

BodyVelocity EstimateInStretch(const PoseSeries& series, const PoseStretch& stretch,
                               const PathRoughness& roughness, std::size_t i,
                               const VelocityOptions& options) {
  BodyVelocity velocity =
      VelocityAt(stretch, roughness, SecondsAfterFirst(series, i), options.max_half_window);
  if (velocity.window == 0) return velocity;
  velocity.status = series[i].measured ? MotionStatus::kOk : MotionStatus::kFilled;
  const auto before = std::upper_bound(stretch.indices.begin(), stretch.indices.end(), i) - 1;
  const PoseSample& nearest = series[*before];
  if (nearest.free_axis_in_world) OpenAbout(*nearest.free_axis_in_world, velocity);
  return velocity;
}

/// Calls `visit(stretch, roughness)` for every stretch that has a velocity.
template <class Visit>
void ForEachStretch(const PoseSeries& series, const VelocityOptions& options, const Visit& visit) {
  CheckSeries(series);
  if (options.max_half_window < 1) {
    throw std::invalid_argument("max_half_window: found " +
                                std::to_string(options.max_half_window) + ", expected 1 or more");
  }
  for (const PoseStretch& stretch : StretchesOf(series, options)) {
    if (stretch.poses.size() < 2) continue;
    visit(stretch, PathRoughness(stretch, kPilotReach * options.max_half_window));
  }
}

}  // namespace

std::vector<BodyVelocity> EstimateVelocities(const PoseSeries& series,
                                             const VelocityOptions& options) {
  std::vector<BodyVelocity> velocities(series.size());
  ForEachStretch(series, options, [&](const PoseStretch& stretch, const PathRoughness& roughness) {
    for (std::size_t i = stretch.indices.front(); i <= stretch.indices.back(); ++i) {
      velocities[i] = EstimateInStretch(series, stretch, roughness, i, options);
    }
  });
  return velocities;
}

BodyVelocity EstimateVelocityOf(const PoseSeries& series, std::size_t frame,
                                const VelocityOptions& options) {
  BodyVelocity velocity;
  ForEachStretch(series, options, [&](const PoseStretch& stretch, const PathRoughness& roughness) {
    if (frame < stretch.indices.front() || frame > stretch.indices.back()) return;
    velocity = EstimateInStretch(series, stretch, roughness, frame, options);
  });
  return velocity;
}

BodyVelocity VelocityOfPoint(const BodyVelocity& origin, const Rigid3& world_from_body,
                             const Eigen::Vector3d& point_in_body_mm,
                             const Eigen::Matrix3d& rotation_covariance_rad2) {
  const Eigen::Vector3d lever = world_from_body.rotation * point_in_body_mm;
  const Eigen::Vector3d& w = origin.omega_rad_s;
  BodyVelocity moved = origin;
  moved.velocity_mm_s += w.cross(lever);
  Matrix12 by = Matrix12::Identity();
  by.block<3, 3>(3, 0) = -Hat(lever);
  Eigen::Matrix<double, 12, 3> by_turn = Eigen::Matrix<double, 12, 3>::Zero();
  by_turn.middleRows<3>(3) = -Hat(w) * Hat(lever);
  if (origin.has_acceleration) {
    moved.acceleration_mm_s2 += origin.alpha_rad_s2.cross(lever) + w.cross(w.cross(lever));
    by.block<3, 3>(9, 0) = -Hat(w.cross(lever)) - Hat(w) * Hat(lever);
    by.block<3, 3>(9, 6) = -Hat(lever);
    by_turn.bottomRows<3>() = -(Hat(origin.alpha_rad_s2) + Hat(w) * Hat(w)) * Hat(lever);
  }
  moved.covariance = by * origin.covariance * by.transpose() +
                     by_turn * rotation_covariance_rad2 * by_turn.transpose();
  return moved;
}

}  // namespace stereomotion
