#pragma once

#include <optional>

#include "stereomotion/calibration/adjust_bundle.h"

namespace stereomotion {

/// Finds the view that fits worst, if it fits plainly worse than views usually do: its images were
/// taken at different moments, or the target moved or bent. One such view bends the whole rig,
/// while most of its points pass for noise one by one. Nothing with fewer than five views.
std::optional<int> FindBadView(const BundleProblem& problem, const BundleSolution& solution);

/// Leaves all observations of a view out.
void LeaveOut(int view, BundleProblem& problem);

/// Where boards lost the view that fixes the world: lays the world into the first view that is
/// left.
void KeepWorldInUsedView(BundleProblem& problem);

}  // namespace stereomotion
