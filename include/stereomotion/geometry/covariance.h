#pragma once

#include <Eigen/Core>

namespace stereomotion {

/// Finds the standard uncertainty in the direction in which a covariance is largest.
double LargestSigma(const Eigen::Matrix3d& covariance);

}  // namespace stereomotion
