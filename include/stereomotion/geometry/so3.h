#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace stereomotion {

/// Makes the matrix of the cross product: `Hat(a) * b = a × b`.
Eigen::Matrix3d Hat(const Eigen::Vector3d& a);

/// Turns a rotation vector [rad] into a unit quaternion with qw ≥ 0.
Eigen::Quaterniond ExpSO3(const Eigen::Vector3d& rotation_rad);

/// Turns a unit quaternion into its rotation vector [rad], length ≤ π. Inverse of `ExpSO3`.
Eigen::Vector3d LogSO3(const Eigen::Quaterniond& rotation);

/// Left Jacobian of SO(3): Exp(a + δ) ≈ Exp(J_l(a) δ) Exp(a) (Barfoot 2017, eq. 7.77).
Eigen::Matrix3d LeftJacobianSO3(const Eigen::Vector3d& rotation_rad);

/// Chooses the sign with qw ≥ 0 (of two equal rotations the one FORMATS.md asks for).
Eigen::Quaterniond WithPositiveW(const Eigen::Quaterniond& rotation);

}  // namespace stereomotion
