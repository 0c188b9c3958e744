#include "stereomotion/motion/screw_axis.h"

#include <cmath>
#include <stdexcept>

#include "stereomotion/geometry/covariance.h"
#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

using Matrix38 = Eigen::Matrix<double, 3, 8>;
/// (δθ, δt) of the motion between two poses by the perturbations of both, (first, second).
using Matrix6x12 = Eigen::Matrix<double, 6, 12>;
using Matrix8x6 = Eigen::Matrix<double, 8, 6>;

constexpr double kLeastSigmas = 3;  // of the angle; below it the direction is noise

void CheckMeasured(const PoseSeries& series, std::size_t i) {
  if (i >= series.size() || !series[i].measured) {
    throw std::invalid_argument("ScrewBetween: sample " + std::to_string(i) + " is no pose");
  }
}

/// x → R x + t of the body between two poses: second · first⁻¹.
Rigid3 MotionBetween(const PoseSample& first, const PoseSample& second) {
  return second.world_from_body * first.world_from_body.Inverse();
}

Matrix6d CovarianceOfMotion(const PoseSample& first, const PoseSample& second,
                            const Rigid3& motion) {
  const Eigen::Matrix3d turn = motion.rotation.toRotationMatrix();
  const Eigen::Matrix3d lever = Hat(motion.rotation * first.world_from_body.translation_mm);
  Matrix6d by_first = Matrix6d::Zero();  // δθ = δθ₂ − R δθ₁; δt = δt₂ − R δt₁ − δθ × R t₁
  by_first << -turn, Eigen::Matrix3d::Zero(), -lever * turn, -turn;
  Matrix6d by_second = Matrix6d::Identity();
  by_second.bottomLeftCorner<3, 3>() = lever;
  return by_first * first.covariance * by_first.transpose() +
         by_second * second.covariance * by_second.transpose();
}

/// Inverse of I − R on the plane across the axis.
Eigen::Matrix3d InverseAcross(const Eigen::Vector3d& n, double angle) {
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - n * n.transpose();
  return 0.5 * (across + Hat(n) / std::tan(angle / 2));
}

/// Inverse of `LeftJacobianSO3` for any angle below 2π (Barfoot 2017, eq. 7.77).
Eigen::Matrix3d InverseLeftJacobian(const Eigen::Vector3d& n, double angle) {
  const double half = angle / 2;
  const double c = half / std::tan(half);
  return c * Eigen::Matrix3d::Identity() + (1 - c) * n * n.transpose() - half * Hat(n);
}

/// Derivative of (direction, point, angle, pitch) by the motion's (δθ, δt). Differentiating
/// (I − R) p = t − d n, d = n·t, gives (I − R) δp = δt − d δn − n δd + δθ × R p.
Matrix8x6 ScrewJacobian(const ScrewAxis& screw, const Rigid3& motion) {
  const Eigen::Vector3d& n = screw.direction;
  const double d = n.dot(motion.translation_mm);
  using Matrix36 = Eigen::Matrix<double, 3, 6>;
  Matrix36 rotation = Matrix36::Zero();
  rotation.leftCols<3>() = InverseLeftJacobian(n, screw.angle_rad);
  Matrix36 shift = Matrix36::Zero();
  shift.rightCols<3>().setIdentity();
  const Matrix36 direction =
      (Eigen::Matrix3d::Identity() - n * n.transpose()) * rotation / screw.angle_rad;
  const Eigen::RowVectorXd angle = n.transpose() * rotation;
  const Eigen::RowVectorXd along =
      motion.translation_mm.transpose() * direction + n.transpose() * shift;
  Matrix36 right = shift - d * direction - n * along;
  right.leftCols<3>() -= Hat(motion.rotation * screw.point_mm);
  Matrix8x6 jacobian;
  jacobian << direction, InverseAcross(n, screw.angle_rad) * right, angle,
      along / screw.angle_rad - d / (screw.angle_rad * screw.angle_rad) * angle;
  return jacobian;
}

}  // namespace

std::optional<ScrewAxis> ScrewBetween(const PoseSeries& series, std::size_t first,
                                      std::size_t second, const Eigen::Vector3d& near_in_body_mm) {
  CheckMeasured(series, first);
  CheckMeasured(series, second);
  const PoseSample& a = series[first];
  const PoseSample& b = series[second];
  if (a.free_axis_in_world || b.free_axis_in_world) return std::nullopt;
  const Rigid3 motion = MotionBetween(a, b);
  const Matrix6d noise = CovarianceOfMotion(a, b, motion);
  const Eigen::Vector3d turn = LogSO3(motion.rotation);
  ScrewAxis screw;
  screw.first = first;
  screw.second = second;
  screw.angle_rad = turn.norm();
  const double sigma = LargestSigma(noise.topLeftCorner<3, 3>());
  if (screw.angle_rad == 0 || screw.angle_rad < kLeastSigmas * sigma) return std::nullopt;
  screw.direction = turn / screw.angle_rad;
  const double along = screw.direction.dot(motion.translation_mm);
  screw.pitch_mm_per_rad = along / screw.angle_rad;
  const Eigen::Vector3d middle =
      (a.world_from_body * near_in_body_mm + b.world_from_body * near_in_body_mm) / 2;
  screw.point_mm = InverseAcross(screw.direction, screw.angle_rad) * motion.translation_mm +
                   screw.direction * screw.direction.dot(middle);
  const Matrix8x6 jacobian = ScrewJacobian(screw, motion);
  screw.covariance = jacobian * noise * jacobian.transpose();
  screw.u_direction_rad = LargestSigma(screw.covariance.topLeftCorner<3, 3>());
  screw.u_point_mm = LargestSigma(screw.covariance.block<3, 3>(3, 3));
  return screw;
}

std::vector<ScrewAxis> ScrewAxes(const PoseSeries& series, const Eigen::Vector3d& near_in_body_mm) {
  std::vector<ScrewAxis> screws;
  std::optional<std::size_t> before;
  for (std::size_t i = 0; i < series.size(); ++i) {
    if (!series[i].measured) continue;
    if (before) {
      const auto screw = ScrewBetween(series, *before, i, near_in_body_mm);
      if (screw) screws.push_back(*screw);
    }
    before = i;
  }
  return screws;
}

}  // namespace stereomotion
