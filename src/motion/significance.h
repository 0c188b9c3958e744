#pragma once

#include <cmath>

namespace stereomotion {

/// What real noise may exceed the stated variance by before a model is called refuted: σ wrong by
/// 12 %. Without it a long recording refutes every model by its noise figures alone.
constexpr double kVarianceSlack = 1.25;

/// Computes the χ² that noise exceeds with probability 1e-3 (Wilson & Hilferty 1931).
inline double LargestChi2(double dof) {
  constexpr double kZ = 3.09;
  const double h = 2 / (9 * dof);
  return dof * std::pow(1 - h + kZ * std::sqrt(h), 3);
}

/// Tells whether residuals contradict their model beyond what noise and slack explain.
inline bool IsAdequate(double chi2, int dof) {
  return dof <= 0 || chi2 <= kVarianceSlack * LargestChi2(dof);
}

}  // namespace stereomotion
