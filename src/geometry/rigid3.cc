#include "stereomotion/geometry/rigid3.h"

#include <stdexcept>

#include "stereomotion/geometry/so3.h"

namespace stereomotion {

Rigid3 Perturb(const Rigid3& a_from_b, const Vector6d& delta) {
  return {(ExpSO3(delta.head<3>()) * a_from_b.rotation).normalized(),
          a_from_b.translation_mm + delta.tail<3>()};
}

Vector6d PerturbationBetween(const Rigid3& from, const Rigid3& to) {
  Vector6d delta;
  delta << LogSO3(to.rotation * from.rotation.conjugate()), to.translation_mm - from.translation_mm;
  return delta;
}

Rigid3 AlignPoints(const Eigen::Matrix3Xd& from_mm, const Eigen::Matrix3Xd& to_mm) {
  if (from_mm.cols() != to_mm.cols() || from_mm.cols() < 3) {
    throw std::invalid_argument("AlignPoints needs two equally long lists of 3 or more points");
  }
  const Eigen::Matrix4d to_from = Eigen::umeyama(from_mm, to_mm, /*with_scaling=*/false);
  return {Eigen::Quaterniond(to_from.topLeftCorner<3, 3>()).normalized(),
          to_from.topRightCorner<3, 1>()};
}

}  // namespace stereomotion
