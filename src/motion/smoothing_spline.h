#pragma once

#include <Eigen/Core>
#include <vector>

#include "motion/weight_row.h"

namespace stereomotion {

/// Minimises Σ w (x − f(t))² + λ ∫ f⁽ᵐ⁾² over all functions: a natural spline of degree 2m − 1 with
/// knots at the data (Reinsch 1967), m = 2 cubic, m = 3 quintic (Woltring 1986). Solved in
/// B-splines (de Boor 1978); time and memory are linear in the data.
class SmoothingSpline {
 public:
  /// Times ascend strictly, at least 2m of them; weights are positive.
  SmoothingSpline(std::vector<double> times, Eigen::VectorXd weights, int m);

  /// Factors the equations for a smoothing parameter; must precede what follows.
  void Factor(double lambda);

  /// Finds the trace of the influence matrix (x → f at the data): how many parameters f has.
  [[nodiscard]] double Trace() const;

  /// Sums Σ w (x − f)² over the columns of `values`.
  [[nodiscard]] double Misfit(const Eigen::MatrixXd& values) const;

  /// Finds the weights of value, first and second derivative at a time.
  [[nodiscard]] WeightRow At(double time) const;

 private:
  [[nodiscard]] int SpanOf(double time) const;
  [[nodiscard]] Eigen::VectorXd Basis(double time, int span, int derivative) const;
  [[nodiscard]] double Knot(int j) const;
  void AddRoughness();
  void SolveBand(Eigen::MatrixXd& right, int& from, int& to) const;

  std::vector<double> times_;
  Eigen::VectorXd weights_;
  int m_, degree_, size_;       ///< half order, degree, number of B-splines
  Eigen::MatrixXd data_basis_;  ///< row s: the 2m B-splines of sample s from its span on
  Eigen::MatrixXd fit_, roughness_, factor_;  ///< lower bands: (i, d) is element (i, i − d)
};

}  // namespace stereomotion
