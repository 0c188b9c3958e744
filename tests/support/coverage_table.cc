#include "tests/support/coverage_table.h"

#include <fmt/format.h>

#include <cmath>

namespace stereomotion::testing {
namespace {

constexpr double kTwoSided95 = 1.959964;
constexpr double kShare = 0.95;
constexpr double kLowest = 0.93, kHighest = 0.97;
constexpr double kLargestRatio = 1.05;

}  // namespace

CoverageTable::Row& CoverageTable::Find(const std::string& quantity) {
  for (Row& row : rows_) {
    if (row.quantity == quantity) return row;
  }
  rows_.push_back({quantity, {}, {}, {}});
  return rows_.back();
}

void CoverageTable::Add(const std::string& quantity, const Eigen::VectorXd& error,
                        const Eigen::MatrixXd& covariance) {
  Row& row = Find(quantity);
  if (row.covered.size() == 0) row.covered = Eigen::VectorXd::Zero(error.size());
  for (Eigen::Index i = 0; i < error.size(); ++i) {
    if (std::fabs(error[i]) < kTwoSided95 * std::sqrt(covariance(i, i))) row.covered[i] += 1;
  }
  row.errors.Add(error, covariance);
}

void CoverageTable::SetBound(const std::string& quantity, const Eigen::MatrixXd& covariance) {
  Find(quantity).bound_rmse = std::sqrt(covariance.trace());
}

std::string CoverageTable::Text(const std::string& title) const {
  std::string text =
      fmt::format("{:34} {:>6} {:>13} {:>9} {:>7} {:>6} {:>11} {:>11} {:>8}\n", title, "reps",
                  "covered %", "NEES/dof", "z", "max z", "RMSE", "stated", "/ bound");
  for (const Row& row : rows_) {
    if (row.errors.samples() == 0) continue;
    const Eigen::VectorXd covered = 100 * row.covered / row.errors.samples();
    text += fmt::format(
        "{:34} {:6d} {:6.2f} {:6.2f} {:9.4f} {:7.2f} {:6.2f} {:11.4g} {:11.4g} {:>8}\n",
        row.quantity, row.errors.samples(), covered.minCoeff(), covered.maxCoeff(),
        row.errors.nees_per_dof(), row.errors.nees_z(), row.errors.worst_z(), row.errors.rmse(),
        row.errors.stated_rmse(),
        row.bound_rmse ? fmt::format("{:.4f}", row.errors.rmse() / *row.bound_rmse) : "");
  }
  return text;
}

std::string CoverageTable::Failures(const Row& row, const Limits& limits, double family_z) {
  if (row.errors.samples() == 0) return {};
  std::string failures;
  // Written so that a NaN fails.
  const Eigen::VectorXd covered = row.covered / row.errors.samples();
  if (!(covered.minCoeff() >= limits.lowest && covered.maxCoeff() <= limits.highest)) {
    failures += fmt::format("{}: 95 % intervals cover {:.4f} to {:.4f}\n", row.quantity,
                            covered.minCoeff(), covered.maxCoeff());
  }
  const auto consistent = IsConsistent(row.errors, family_z);
  if (!consistent) failures += row.quantity + ": " + consistent.message() + "\n";
  if (row.bound_rmse && !(row.errors.rmse() <= limits.ratio * *row.bound_rmse)) {
    failures += fmt::format("{}: RMSE {} of the bound\n", row.quantity,
                            row.errors.rmse() / *row.bound_rmse);
  }
  return failures;
}

::testing::AssertionResult CoverageTable::Holds(int repetitions, double family_z) const {
  std::string failures;
  for (const Row& row : rows_) {
    const int n = row.errors.samples();
    if (n < repetitions) failures += fmt::format("{}: only {} repetitions\n", row.quantity, n);
    failures += Failures(row, {kLowest, kHighest, kLargestRatio}, family_z);
  }
  if (rows_.empty()) failures = "nothing was measured\n";
  return failures.empty() ? ::testing::AssertionSuccess()
                          : ::testing::AssertionFailure() << failures;
}

::testing::AssertionResult CoverageTable::CoversAtLeast(int repetitions, double family_z) const {
  std::string failures;
  for (const Row& row : rows_) {
    const int n = row.errors.samples();
    if (n < repetitions) failures += fmt::format("{}: only {} repetitions\n", row.quantity, n);
    const double covered = n == 0 ? 0 : row.covered.minCoeff() / n;
    // Written so that a NaN fails.
    if (!(covered >= kLowest && row.errors.nees_z() <= family_z)) {
      failures += fmt::format("{}: 95 % intervals cover only {:.4f}, NEES/dof {:.4f}\n",
                              row.quantity, covered, row.errors.nees_per_dof());
    }
  }
  if (rows_.empty()) failures = "nothing was measured\n";
  return failures.empty() ? ::testing::AssertionSuccess()
                          : ::testing::AssertionFailure() << failures;
}

::testing::AssertionResult CoverageTable::IsPlausible(double family_z) const {
  std::string failures;
  for (const Row& row : rows_) {
    const int n = row.errors.samples();
    if (n == 0) failures += row.quantity + ": nothing was measured\n";
    const double spread = family_z * std::sqrt(kShare * (1 - kShare) / n);
    // The RMSE of components that are fully correlated is as uncertain as that of one.
    failures += Failures(row, {kShare - spread, kShare + spread, 1 + family_z / std::sqrt(2.0 * n)},
                         family_z);
  }
  if (rows_.empty()) failures = "nothing was measured\n";
  return failures.empty() ? ::testing::AssertionSuccess()
                          : ::testing::AssertionFailure() << failures;
}

}  // namespace stereomotion::testing
