#pragma once

#include <Eigen/Core>
#include <optional>

#include "motion/center_model.h"

namespace stereomotion {

/// Holds what the data says about the global unknowns around a solution.
struct GlobalInformation {
  Eigen::MatrixXd covariance;        ///< random, of all globals
  Eigen::MatrixXd inverse_observed;  ///< of the observed Hessian: maps gradients to errors
  /// Of Gauss–Newton's information, the share that is left when what the noise of the rotations
  /// feigns is taken away, in the worst direction: 1 − noise² / signal².
  double least_share = 1;
};

/// Propagates the residuals' unit variance to the globals, local unknowns eliminated.
///
/// Each frame's rotation is an unknown with a noise of its own, so the centre is a problem with
/// errors in variables: Gauss–Newton's Hessian G (the gradient's variance) holds the squared noise
/// of the rotations as if it were information, the observed Hessian A = G + second derivatives does
/// not. The error is A⁻¹ · gradient, its covariance A⁻¹ G A⁻¹ (Fuller 1987, ch. 1.3; Huber 1967).
/// Where noise ≪ range, A = G. From triangular factors, undamped: G = UᵀU, A = Uᵀ(I + E)U. Nothing
/// where the equations are singular or the noise hides the signal.
std::optional<GlobalInformation> InformationOf(const CenterModel& model,
                                               const CenterUnknowns& unknowns);

}  // namespace stereomotion
