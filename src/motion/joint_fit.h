#pragma once

#include <Eigen/Core>
#include <vector>

#include "stereomotion/geometry/rigid3.h"

namespace stereomotion {

using Matrix12d = Eigen::Matrix<double, 12, 12>;

/// Holds the poses of two bodies at one time.
struct PosePair {
  Rigid3 first, second;  ///< world_from_body
  Matrix6d first_covariance, second_covariance;
};

/// Holds two centres (first, second) and what the poses say against R₁ c₁ + t₁ = R₂ c₂ + t₂.
struct JointFit {
  Vector6d centers_mm;
  double chi2 = 0;
  /// Gauss–Newton and expected Hessian of χ²/2 by the centres; they differ by the noise of the
  /// adjusted rotations in the Jacobian (errors in variables).
  Matrix6d gauss_newton, hessian;
  Vector6d gradient;
  double squares_mm2 = 0;  ///< of the distance of both images of the centre, as measured
};

/// Evaluates given centres: every frame's poses are adjusted, in their covariances, so that the
/// centres coincide (Gauss–Helmert model; the poses are thus unknowns, condensed).
JointFit EvaluateJoint(const std::vector<PosePair>& pairs, const Vector6d& centers_mm);

/// Finds the most likely centres within the space that the columns of `basis` (orthonormal, 6×k)
/// span. Starts from linear least squares (SCoRE, Ehrig 2006).
JointFit FitJoint(const std::vector<PosePair>& pairs, const Eigen::MatrixXd& basis);

}  // namespace stereomotion
