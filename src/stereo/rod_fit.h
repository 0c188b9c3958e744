#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "stereomotion/stereo/find_rods.h"

namespace stereomotion {

/// Tolerance and noise add up (a + b) where a distance is tested, but add in quadrature in a
/// normalised deviation; (a + b)² ≤ 2 (a² + b²), so this factor lets through all that the first
/// lets.
constexpr double kRodGateSlack = 2;

/// Computes dᵀ (C + σ² I)⁻¹ d.
double NormalizedSquare(const Eigen::Vector3d& deviation_mm, const Eigen::Matrix3d& covariance_mm2,
                        double extra_sigma_mm);

/// Fits the rod as a straight line of known spacing (position and direction, five unknowns) to the
/// candidates in `set` (per ball of the rod, −1: none), weighted by their covariances and by the
/// tolerance; drops balls beyond the gate, worst first. `place_mm`: of each ball along the rod.
/// Nothing where fewer than `min_balls` stay. `rod` stays −1.
std::optional<RodCandidate> FitRod(const std::vector<StereoCandidate>& candidates,
                                   const std::vector<double>& place_mm, std::vector<int> set,
                                   const RodOptions& options);

}  // namespace stereomotion
