#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace stereomotion {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Maps coordinates of one frame to another: `a_from_b * p_in_b_mm = p_in_a_mm`.
struct Rigid3 {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation_mm = Eigen::Vector3d::Zero();

  Eigen::Vector3d operator*(const Eigen::Vector3d& p_mm) const {
    return rotation * p_mm + translation_mm;
  }
  Rigid3 operator*(const Rigid3& b_from_c) const {
    return {(rotation * b_from_c.rotation).normalized(),
            rotation * b_from_c.translation_mm + translation_mm};
  }
  [[nodiscard]] Rigid3 Inverse() const {
    const Eigen::Quaterniond inverse = rotation.conjugate();
    return {inverse, -(inverse * translation_mm)};
  }
};

/// Applies FORMATS.md's perturbation: `R = Exp(δθ) R̂`, `t = t̂ + δt`, `delta` = (δθ [rad], δt [mm]).
Rigid3 Perturb(const Rigid3& a_from_b, const Vector6d& delta);

/// Inverse of `Perturb`: the (δθ, δt) that leads from `from` to `to`.
Vector6d PerturbationBetween(const Rigid3& from, const Rigid3& to);

/// Finds the rigid motion that maps `from_mm` (3×N) onto `to_mm` (3×N) with least squares
/// (Horn 1987 / Umeyama 1991 without scale). N ≥ 3, not all on a line.
Rigid3 AlignPoints(const Eigen::Matrix3Xd& from_mm, const Eigen::Matrix3Xd& to_mm);

}  // namespace stereomotion
