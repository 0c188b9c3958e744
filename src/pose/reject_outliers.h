#pragma once

#include <optional>

#include "pose/solve_pose.h"

namespace stereomotion {

/// Solves with gross errors dropped, worst first.
///
/// The worst observation is the one whose deletion lowers χ² most, d = rᵀ (I − J C Jᵀ)⁻¹ r (χ² of 2
/// degrees of freedom where the models hold; Cook & Weisberg 1982): an error with leverage does not
/// hide behind the residuals that it causes elsewhere. It goes if d > (`reject_sigma` × scale)²,
/// where scale² = max(1, median(d) / 1.386): a wrong rig inflates all residuals alike. What the
/// final pose agrees with comes back. Nothing where the remaining observations leave the pose open.
std::optional<PoseSolution> SolveWithoutOutliers(PoseProblem& problem, const PoseState& initial,
                                                 const PoseOptions& options);

/// Finds the smallest share of any ball's measurement that the other balls check: the least
/// eigenvalue of I − J C Jᵀ over the ball's active observations (redundancy number; Baarda 1968).
/// 0: one ball alone decides on some direction, so that its error would go unnoticed.
double SmallestRedundancy(const PoseProblem& problem, const PoseSolution& solution);

}  // namespace stereomotion
