#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/statistics.h"

namespace stereomotion::testing {

/// Gathers over the repetitions of a Monte Carlo test how reported quantities err against their
/// stated covariances, and against a bound.
class CoverageTable {
 public:
  /// Adds the error of one repetition. All repetitions of a quantity have the same size.
  void Add(const std::string& quantity, const Eigen::VectorXd& error,
           const Eigen::MatrixXd& covariance);
  /// States the smallest possible covariance of a quantity.
  void SetBound(const std::string& quantity, const Eigen::MatrixXd& covariance);

  /// Spells a row a quantity: coverage of the 95 % intervals (lowest and highest component), NEES,
  /// RMSE against what is stated and against the bound.
  [[nodiscard]] std::string Text(const std::string& title) const;

  /// Checks what DESIGN.md and the issue ask for: at least `repetitions` of every quantity, every
  /// component's 95 % interval holds the truth in 95 ± 2 %, the NEES is consistent, and the RMSE is
  /// at most 1.05 times the bound where one is stated.
  [[nodiscard]] ::testing::AssertionResult Holds(int repetitions, double family_z) const;
  /// Checks the lower side only, for covariances that hold the bound of a bias: every component's
  /// interval holds the truth in at least 93 %, and the NEES does not exceed its bound.
  [[nodiscard]] ::testing::AssertionResult CoversAtLeast(int repetitions, double family_z) const;
  /// Checks the same as far as few repetitions can tell: shares to `family_z` of the binomial's
  /// spread, the RMSE to that of χ².
  [[nodiscard]] ::testing::AssertionResult IsPlausible(double family_z) const;

 private:
  /// What shares and RMSE may be.
  struct Limits {
    double lowest, highest, ratio;
  };
  struct Row {
    std::string quantity;
    ErrorStatistics errors;
    Eigen::VectorXd covered;  ///< repetitions, by component
    std::optional<double> bound_rmse;
  };
  Row& Find(const std::string& quantity);
  static std::string Failures(const Row& row, const Limits& limits, double family_z);
  std::vector<Row> rows_;
};

}  // namespace stereomotion::testing
