#pragma once

#include <algorithm>
#include <cmath>

namespace stereomotion {

/// Density of two standard normal numbers of correlation `rho`.
inline double BivariateDensity(double h, double k, double rho) {
  constexpr double kTwoPi = 6.28318530717958648;
  const double rest = 1 - rho * rho;
  return std::exp(-(h * h - 2 * rho * h * k + k * k) / (2 * rest)) / (kTwoPi * std::sqrt(rest));
}

/// Integrates `BivariateDensity` over its correlation from 0 to `rho`: what the correlation adds to
/// Φ(h) Φ(k) (Plackett 1954; Drezner & Wesolowsky 1990, Gauss–Legendre of five points). Better than
/// 1e-5 for |rho| ≤ 0.8.
inline double CorrelationShare(double h, double k, double rho) {
  constexpr double kNodes[] = {0.04691007703066802, 0.23076534494715845, 0.5, 0.76923465505284155,
                               0.95308992296933198};
  constexpr double kWeights[] = {0.11846344252809454, 0.23931433524968324, 0.28444444444444444,
                                 0.23931433524968324, 0.11846344252809454};
  // So many standard deviations from an edge the other one is alone, to 1e-5.
  constexpr double kFar = 4.3;
  if (std::max(std::fabs(h), std::fabs(k)) > kFar) return 0;
  double sum = 0;
  for (int i = 0; i < 5; ++i) sum += kWeights[i] * BivariateDensity(h, k, kNodes[i] * rho);
  return rho * sum;
}

}  // namespace stereomotion
