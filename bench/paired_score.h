#pragma once

#include <string>
#include <vector>

namespace stereomotion::bench {

/// Holds the errors of one method, trial by trial.
struct MethodErrors {
  std::string method;
  bool is_baseline = true;
  std::vector<double> errors;  ///< infinite where the method gave no answer
  /// eᵀ C⁻¹ e of the trials, where the method states a covariance.
  std::vector<double> nees;
  int nees_dof = 0;
};

double Rmse(const std::vector<double>& errors);

/// Gives the value below which the share `q` of the errors lies.
double Quantile(std::vector<double> errors, double q);

/// Compares the RMSE of two methods in the same trials.
struct PairedRatio {
  double ratio = 0;  ///< RMSE of the first / RMSE of the second
  /// 99.9 % confidence limits, one-sided each, of the ratio: delta method on the mean squares,
  /// with the covariance of the paired trials.
  double lower = 0, upper = 0;
};
PairedRatio CompareRmse(const std::vector<double>& first, const std::vector<double>& second);

/// Finds the baseline of smallest RMSE.
const MethodErrors& BestBaseline(const std::vector<MethodErrors>& methods);

}  // namespace stereomotion::bench
