#pragma once

#include <string>

#include "motion/center_problem.h"
#include "stereomotion/motion/spin_center.h"

namespace stereomotion {

/// Says in words how well the spin centre is known, and why not better.
std::string CenterVerdict(const CenterProblem& problem, const SpinCenterResult& result);

/// Finds the largest angle between two poses: exact but for flukes, at linear cost (each round
/// takes the pose farthest from the last).
double RangeOfRotation(const std::vector<ObservedFrame>& frames);

}  // namespace stereomotion
