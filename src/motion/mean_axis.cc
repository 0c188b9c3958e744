#include <algorithm>
#include <cmath>

#include "motion/axis_fit.h"
#include "motion/screw_fit.h"
#include "motion/significance.h"
#include "motion/velocity_window.h"
#include "stereomotion/geometry/covariance.h"
#include "stereomotion/geometry/so3.h"
#include "stereomotion/motion/screw_axis.h"
#include "stereomotion/motion/velocity.h"

namespace stereomotion {
namespace {

constexpr int kDriftUnknowns = kScrewAndDrift - kScrewUnknowns;
constexpr double kLeastSigmas = 3;  // of ω; below it no instantaneous axis is determined

/// Finds the measured sample nearest the middle of the time that the measured ones span.
std::size_t MiddleOf(const PoseSeries& series) {
  std::vector<std::size_t> measured;
  for (std::size_t i = 0; i < series.size(); ++i) {
    if (series[i].measured) measured.push_back(i);
  }
  const double twice =
      SecondsAfterFirst(series, measured.front()) + SecondsAfterFirst(series, measured.back());
  return *std::min_element(measured.begin(), measured.end(), [&](std::size_t a, std::size_t b) {
    return std::abs(2 * SecondsAfterFirst(series, a) - twice) <
           std::abs(2 * SecondsAfterFirst(series, b) - twice);
  });
}

bool IsPure(const ScrewFit& fit) {
  return IsAdequate(fit.chi2, fit.dof) &&
         fit.drift_chi2 <= kVarianceSlack * LargestChi2(kDriftUnknowns);
}

void UseScrew(const ScrewFit& fit, MeanAxis& mean) {
  mean.line_direction = fit.model.direction;
  mean.point_in_world_mm = fit.model.point_mm;
  mean.pitch_mm_per_rad = fit.model.pitch_mm_per_rad;
  const Eigen::Matrix<double, 3, 2> across = AcrossBasis(fit.model.direction);
  // The fit turns the direction about the vectors of the basis.
  const Eigen::Matrix<double, 3, 2> tilts = Hat(fit.model.direction) * across;
  mean.line_direction_covariance = tilts * fit.covariance.topLeftCorner<2, 2>() * tilts.transpose();
  mean.point_covariance_mm2 = across * fit.covariance.block<2, 2>(2, 2) * across.transpose();
  mean.u_pitch = std::sqrt(fit.covariance(4, 4));
}

/// Instantaneous screw axis of a local motion, its point nearest `near_mm`.
struct Instant {
  Eigen::Vector3d direction, point_mm;
  double pitch;
};

Instant InstantAxis(const Eigen::Vector3d& omega, const Eigen::Vector3d& velocity,
                    const Eigen::Vector3d& origin_mm, const Eigen::Vector3d& near_mm) {
  const double omega2 = omega.squaredNorm();
  const Eigen::Vector3d n = omega / std::sqrt(omega2);
  const Eigen::Vector3d point = origin_mm + omega.cross(velocity) / omega2;
  return {n, point + n * n.dot(near_mm - point), omega.dot(velocity) / omega2};
}

/// Derivative of the point (across the axis) and the pitch by (ω, v, origin).
Eigen::Matrix<double, 4, 9> InstantJacobian(const Instant& at, const Eigen::Vector3d& omega,
                                            const Eigen::Vector3d& velocity,
                                            const Eigen::Vector3d& origin_mm) {
  const double omega2 = omega.squaredNorm();
  const Eigen::Vector3d from_origin = omega.cross(velocity) / omega2;
  const Eigen::RowVector3d inward = 2 * omega.transpose() / omega2;
  const Eigen::Matrix3d across =
      Eigen::Matrix3d::Identity() - at.direction * at.direction.transpose();
  // The axis also tilts: by δn it moves at the point, which lies `along` it from the origin's foot.
  const double along = at.direction.dot(at.point_mm - origin_mm);
  Eigen::Matrix<double, 4, 9> jacobian;
  jacobian.row(3) << velocity.transpose() / omega2 - at.pitch * inward, omega.transpose() / omega2,
      Eigen::RowVector3d::Zero();
  jacobian.topRows<3>() << -Hat(velocity) / omega2 - from_origin * inward +
                               along * across / omega.norm(),
      Hat(omega) / omega2, Eigen::Matrix3d::Identity();
  jacobian.topRows<3>() = (across * jacobian.topRows<3>()).eval();
  return jacobian;
}

/// Takes point and pitch from the local motion at mid-run.
bool UseInstant(const PoseSeries& series, std::size_t middle, const Eigen::Vector3d& near_mm,
                MeanAxis& mean) {
  const BodyVelocity local = EstimateVelocityOf(series, middle);
  const Eigen::Matrix3d noise = local.covariance.topLeftCorner<3, 3>();
  if (local.status == MotionStatus::kGap || local.open_axis_in_world ||
      local.omega_rad_s.norm() < kLeastSigmas * LargestSigma(noise)) {
    return false;
  }
  const Eigen::Vector3d& origin = series[middle].world_from_body.translation_mm;
  const Instant at = InstantAxis(local.omega_rad_s, local.velocity_mm_s, origin, near_mm);
  Eigen::Matrix<double, 9, 9> covariance = Eigen::Matrix<double, 9, 9>::Zero();
  covariance.topLeftCorner<6, 6>() = local.covariance.topLeftCorner<6, 6>();
  covariance.bottomRightCorner<3, 3>() = series[middle].covariance.bottomRightCorner<3, 3>();
  const auto jacobian = InstantJacobian(at, local.omega_rad_s, local.velocity_mm_s, origin);
  const Eigen::Matrix4d of_line = jacobian * covariance * jacobian.transpose();
  mean.line_direction = at.direction;
  const Eigen::Matrix3d tilt =
      (Eigen::Matrix3d::Identity() - at.direction * at.direction.transpose()) /
      local.omega_rad_s.norm();
  mean.line_direction_covariance = tilt * noise * tilt;
  mean.point_in_world_mm = at.point_mm;
  mean.pitch_mm_per_rad = at.pitch;
  mean.point_covariance_mm2 = of_line.topLeftCorner<3, 3>();
  mean.u_pitch = std::sqrt(of_line(3, 3));
  return true;
}

}  // namespace

Expected<MeanAxis, AxisFailure> FindMeanAxis(const PoseSeries& series,
                                             const Eigen::Vector3d& near_in_body_mm,
                                             AxisMotion known) {
  const Expected<OneAxis, AxisFailure> axis = FitOneAxis(series);
  if (!axis) return Unexpected{axis.error()};
  MeanAxis mean;
  mean.axis = *axis;
  mean.u_direction_rad = LargestSigma(axis->covariance_in_world);
  const std::size_t middle = MiddleOf(series);
  const Eigen::Vector3d near_mm = series[middle].world_from_body * near_in_body_mm;
  const std::optional<ScrewFit> fit = FitScrew(series, *axis, near_mm, known == AxisMotion::kHinge);
  if (fit) {
    mean.chi2 = fit->chi2;
    mean.dof = fit->dof;
  }
  mean.pure_screw = fit && IsPure(*fit);
  if (fit && (known != AxisMotion::kAny || mean.pure_screw)) {
    UseScrew(*fit, mean);
  } else if (!UseInstant(series, middle, near_mm, mean)) {
    return Unexpected{AxisFailure::kNoRotation};
  }
  mean.u_point_mm = LargestSigma(mean.point_covariance_mm2);
  return mean;
}

}  // namespace stereomotion
