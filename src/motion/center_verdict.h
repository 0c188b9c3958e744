#pragma once

#include <string>

#include "motion/center_problem.h"
#include "stereomotion/motion/spin_center.h"

namespace stereomotion {

/// Says in words how well the spin centre is known, and why not better.
std::string CenterVerdict(const CenterProblem& problem, const SpinCenterResult& result);

/// Finds the largest angle between two poses, of one rod (whose roll is arbitrary) between two of
/// its directions: exact but for flukes, at linear cost (each round takes the pose farthest from
/// the last).
double RangeOfRotation(const CenterProblem& problem);

}  // namespace stereomotion
