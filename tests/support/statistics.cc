#include "tests/support/statistics.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace stereomotion::testing {
namespace {

constexpr double kFamilyLevel = 0.999;
constexpr double kWorstZ = 5;
constexpr int kManySamples = 2000;

}  // namespace

double FamilyZ(int tests) {
  const double both_tails = 1 - std::pow(kFamilyLevel, 1.0 / tests);
  double low = 0;
  double high = 10;
  while (high - low > 1e-9) {
    const double z = (low + high) / 2;
    (std::erfc(z / std::sqrt(2.0)) > both_tails ? low : high) = z;
  }
  return high;
}

double ChiSquareTail(double chi2, int even_dof) {
  double term = std::exp(-chi2 / 2);
  double tail = term;
  for (int i = 1; i < even_dof / 2; ++i) {
    term *= chi2 / 2 / i;
    tail += term;
  }
  return tail;
}

void ErrorStatistics::Add(const Eigen::VectorXd& error, const Eigen::MatrixXd& covariance) {
  const double nees = error.dot(covariance.llt().solve(error));
  nees_ += nees;
  worst_nees_ = std::max(worst_nees_, nees);
  const Eigen::VectorXd sigmas = covariance.diagonal().cwiseSqrt();
  worst_z_ = std::max(worst_z_, error.cwiseQuotient(sigmas).cwiseAbs().maxCoeff());
  error2_ += error.squaredNorm();
  stated2_ += covariance.trace();
  sum_ += error.sum();
  dof_ += static_cast<int>(error.size());
  ++samples_;
}

double ErrorStatistics::nees_z() const {
  const double a = 2.0 / (9 * dof_);
  return (std::cbrt(nees_per_dof()) - (1 - a)) / std::sqrt(a);
}

double ErrorStatistics::rmse() const { return std::sqrt(error2_ / samples_); }
double ErrorStatistics::stated_rmse() const { return std::sqrt(stated2_ / samples_); }
double ErrorStatistics::stated_bias_sigma() const { return std::sqrt(stated2_) / samples_; }

::testing::AssertionResult IsConsistent(const ErrorStatistics& errors, double family_z) {
  const double ratio = errors.nees_per_dof();
  const bool inside = std::fabs(errors.nees_z()) < family_z;
  const bool enough = errors.samples() > kManySamples && ratio > 0.95 && ratio < 1.05;
  // Written so that a NaN fails.
  if ((inside || enough) && errors.worst_z() < kWorstZ) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure()
         << "NEES/dof " << ratio << " (z " << errors.nees_z() << ", bound " << family_z << ", "
         << errors.samples() << " samples), worst |z| " << errors.worst_z() << " (bound " << kWorstZ
         << ")";
}

}  // namespace stereomotion::testing
