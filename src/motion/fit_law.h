#pragma once

#include <vector>

#include "motion/center_problem.h"
#include "stereomotion/motion/spin_center.h"

namespace stereomotion {

/// Counts the coefficients of a law's path; 0: free.
int PathTerms(PathLaw law);

/// Fits a law (not free) to all frames: χ², degrees of freedom, BIC, and the centre where the law
/// determines it. `adequate` is left open.
LawFit FitLaw(const CenterProblem& problem, PathLaw law, bool with_calibration);

/// Fits a path of order 3, as evidence against all laws: no centre.
LawFit FitCubic(const CenterProblem& problem);

/// Tells what the frames say without any law.
LawFit FitFree(const CenterProblem& problem);

/// Finds the frames (places in `problem.frames`) whose centre lies farther off the path of a law
/// than `reject_sigma` times the robust spread of all. None where more than a third would go: then
/// it is the law that fails.
std::vector<std::size_t> FindGrossFrames(const CenterProblem& problem, PathLaw law,
                                         double reject_sigma);

}  // namespace stereomotion
