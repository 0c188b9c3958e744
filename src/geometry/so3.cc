#include "stereomotion/geometry/so3.h"

#include <cmath>

namespace stereomotion {

Eigen::Matrix3d Hat(const Eigen::Vector3d& a) {
  Eigen::Matrix3d hat;
  hat << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return hat;
}

Eigen::Quaterniond WithPositiveW(const Eigen::Quaterniond& rotation) {
  return rotation.w() < 0 ? Eigen::Quaterniond(-rotation.coeffs()) : rotation;
}

Eigen::Quaterniond ExpSO3(const Eigen::Vector3d& rotation_rad) {
  const double angle = rotation_rad.norm();
  // sin(a/2)/a by its series where the quotient would lose digits.
  const double k = angle < 1e-4 ? 0.5 - angle * angle / 48 : std::sin(angle / 2) / angle;
  const Eigen::Vector3d v = k * rotation_rad;
  return WithPositiveW(Eigen::Quaterniond(std::cos(angle / 2), v.x(), v.y(), v.z()).normalized());
}

Eigen::Vector3d LogSO3(const Eigen::Quaterniond& rotation) {
  const Eigen::Quaterniond q = WithPositiveW(rotation);
  const double sine = q.vec().norm();
  if (sine < 1e-9) return 2 * q.vec();
  return 2 * std::atan2(sine, q.w()) / sine * q.vec();
}

Eigen::Matrix3d LeftJacobianSO3(const Eigen::Vector3d& rotation_rad) {
  const double angle = rotation_rad.norm();
  const Eigen::Matrix3d hat = Hat(rotation_rad);
  if (angle < 1e-4) return Eigen::Matrix3d::Identity() + hat / 2 + hat * hat / 6;
  const double a2 = angle * angle;
  return Eigen::Matrix3d::Identity() + (1 - std::cos(angle)) / a2 * hat +
         (angle - std::sin(angle)) / (a2 * angle) * hat * hat;
}

}  // namespace stereomotion
