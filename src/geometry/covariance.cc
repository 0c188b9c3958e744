#include "stereomotion/geometry/covariance.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace stereomotion {

double LargestSigma(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(solver.eigenvalues()[2], 0.0));
}

}  // namespace stereomotion
