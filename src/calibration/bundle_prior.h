#pragma once

#include <Eigen/Core>

#include "bundle_normals.h"
#include "bundle_unknowns.h"

namespace stereomotion {

// The cameras' prior in a bundle adjustment; without one each does nothing.

/// Throws std::invalid_argument for a prior that names what is not estimated, or whose covariance
/// is not positive definite.
void CheckPrior(const BundleProblem& problem, const BundleUnknowns& unknowns);

/// Evaluates χ² of the cameras' present state against the prior.
double PriorChi2(const BundleProblem& problem);

/// Adds the prior to the normal equations.
void AddPrior(const BundleProblem& problem, const BundleUnknowns& unknowns, BundleNormals& normals);

/// Counts what of the prior is redundant, given the covariance of the global unknowns: what its χ²
/// is expected to be.
double PriorRedundancy(const BundleProblem& problem, const BundleUnknowns& unknowns,
                       const Eigen::MatrixXd& global_covariance);

}  // namespace stereomotion
