#pragma once

#include <cmath>

namespace stereomotion {

constexpr double kPi = 3.14159265358979323846;

/// Density of the standard normal distribution.
inline double NormalDensity(double z) { return std::exp(-0.5 * z * z) / std::sqrt(2 * kPi); }

/// Probability that a standard normal number lies below `z`.
inline double NormalCdf(double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }

}  // namespace stereomotion
