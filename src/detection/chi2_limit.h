#pragma once

#include <cmath>

namespace stereomotion {

/// Computes the largest χ²/dof that noise alone reaches with probability 10^-exponent (Wilson &
/// Hilferty 1931).
inline double LargestChi2Dof(double dof, double exponent) {
  const double z = std::sqrt(2 * exponent * std::log(10.0));
  const double h = 2 / (9 * dof);
  return std::pow(1 - h + z * std::sqrt(h), 3);
}

}  // namespace stereomotion
