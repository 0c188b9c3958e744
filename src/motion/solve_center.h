#pragma once

#include <vector>

#include "motion/center_model.h"

namespace stereomotion {

/// Holds a linear start, and the frames that contradict it.
struct CenterStart {
  Eigen::VectorXd globals;
  /// Of every frame, the squared distance of its centre from the path [σ²]: three degrees of
  /// freedom.
  std::vector<double> excess;
  double scale = 1;  ///< robust σ of the distances in their stated σ; at least 1
};

/// Solves a model of poses (no points) linearly, robust against gross frames: reweighted least
/// squares (Cauchy), rotations eliminated at their measured values.
CenterStart StartCenter(const CenterModel& model);

/// Minimises all residuals together, rotations eliminated first (Ceres, Schur complement).
/// Returns χ², or a negative number where a camera cannot see a ball at the start.
double SolveCenter(const CenterModel& model, CenterUnknowns& unknowns);

}  // namespace stereomotion
