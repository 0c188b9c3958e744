#pragma once

#include <optional>
#include <vector>

#include "pose/pose_problem.h"

namespace stereomotion {

/// Holds the least-squares answer over the active observations.
struct PoseSolution {
  PoseState state;
  std::vector<ObservationFit> fits;  ///< of all observations, the rejected ones included
  /// Inverse Hessian of (δθ about the pivot [rad], δpivot [mm]); zero along a free axis.
  Matrix6d covariance;
  double chi2 = 0;
  int active = 0;
  int unknowns = 6;
};

/// Minimises the whitened residuals of the active observations: Gauss–Newton, with Levenberg's
/// damping only where a full step does not go down. An observation whose ball cannot be projected
/// becomes inactive. Nothing where the active observations leave the pose open, or without
/// convergence.
std::optional<PoseSolution> SolvePose(PoseProblem& problem, const PoseState& initial,
                                      int max_iterations);

/// Moves a state by (δθ about the pivot, δpivot).
PoseState Step(const PoseState& state, const Vector6d& delta);

}  // namespace stereomotion
