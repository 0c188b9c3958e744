#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>

namespace stereomotion::testing {

/// Finds the two-sided bound |z| of one test out of `tests`, so that a perfect engine passes all of
/// them together with 99.9 % (Šidák; DESIGN.md, "consistent").
double FamilyZ(int tests);

/// Computes P(χ² > `chi2`) for an even number of degrees of freedom, exactly.
double ChiSquareTail(double chi2, int even_dof);

/// Gathers errors that should be draws from the covariances that were stated for them.
class ErrorStatistics {
 public:
  void Add(const Eigen::VectorXd& error, const Eigen::MatrixXd& covariance);

  [[nodiscard]] int samples() const { return samples_; }
  [[nodiscard]] double nees() const { return nees_; }
  [[nodiscard]] int dof() const { return dof_; }
  [[nodiscard]] double nees_per_dof() const { return nees_ / dof_; }
  /// Spells the NEES as a standard normal number (Wilson & Hilferty 1931).
  [[nodiscard]] double nees_z() const;
  /// Largest |error| / σ of any component of any sample.
  [[nodiscard]] double worst_z() const { return worst_z_; }
  /// Largest NEES of one sample.
  [[nodiscard]] double worst_nees() const { return worst_nees_; }
  /// Root of the summed squared error over all components, mean over the samples.
  [[nodiscard]] double rmse() const;
  /// What `rmse` should be by the stated covariances.
  [[nodiscard]] double stated_rmse() const;
  /// Mean error; samples of one component only.
  [[nodiscard]] double bias() const { return sum_ / samples_; }
  [[nodiscard]] double stated_bias_sigma() const;

 private:
  int samples_ = 0, dof_ = 0;
  double nees_ = 0, worst_z_ = 0, worst_nees_ = 0, error2_ = 0, stated2_ = 0, sum_ = 0;
};

/// Checks what DESIGN.md calls consistent: the NEES inside its two-sided χ² interval at `family_z`
/// (or, beyond 2 000 samples, NEES/dof within 0.95–1.05), and no single |z| above 5.
::testing::AssertionResult IsConsistent(const ErrorStatistics& errors, double family_z);

}  // namespace stereomotion::testing
