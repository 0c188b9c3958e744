#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "stereomotion/motion/motion_data.h"

namespace stereomotion {

/// Makes two unit vectors that complete the unit vector `a` to a right-handed triad.
Eigen::Matrix<double, 3, 2> AcrossBasis(const Eigen::Vector3d& a);

/// Inverts a symmetric semi-definite matrix on the space where it says something.
Eigen::MatrixXd PseudoInverse(const Eigen::MatrixXd& symmetric);

/// Holds one rotation with the covariance of its left perturbation.
struct NoisyRotation {
  Eigen::Matrix3d rotation;
  Eigen::Matrix3d covariance_rad2;
  std::optional<Eigen::Vector3d> free_axis;  ///< in the rotation's target frame
  double time_s = 0;
};

/// Holds a pair of axes and what the rotations say against it.
struct AxisPair {
  Eigen::Vector3d in_body, in_world;
  double chi2 = 0;
  /// Gauss–Newton and expected Hessian of χ²/2 by rotation of (in_body, in_world), each in its
  /// `AcrossBasis`. They differ by the noise of the poses in the Jacobian.
  Eigen::Matrix4d gauss_newton, hessian;
  Eigen::Vector4d gradient;
  std::vector<Eigen::Matrix3d> fitted;  ///< rotations moved so that they obey the axis
  double squared_angles_rad2 = 0;       ///< sum over the rotations, of R · in_body from in_world
};

/// Collects the measured rotations; throws where a covariance is not positive definite.
std::vector<NoisyRotation> MeasuredRotations(const PoseSeries& series);

/// Evaluates R_t · in_body = in_world.
AxisPair EvaluateAxis(const std::vector<NoisyRotation>& rotations, const Eigen::Vector3d& in_body,
                      const Eigen::Vector3d& in_world);

/// Minimises χ² from a start: Gauss–Newton with halved steps.
AxisPair RefineAxis(const std::vector<NoisyRotation>& rotations, const Eigen::Vector3d& in_body,
                    const Eigen::Vector3d& in_world);

/// Angles about the axis from the first pose on; a step is taken nearest to what the rate of the
/// step before foretells, so that a gap may hide whole turns of a steady rotation.
std::vector<double> UnwrappedAngles(const std::vector<NoisyRotation>& rotations,
                                    const AxisPair& pair);

/// Finds axes to start from; several where the rotations leave their own free axis open.
std::vector<AxisPair> StartAxes(const std::vector<NoisyRotation>& rotations);

}  // namespace stereomotion
