#pragma once

namespace stereomotion {

/// Holds the moments of a normal number after rounding to whole numbers.
struct RoundedNormal {
  double mean = 0;
  double variance = 0;
  double squares_variance = 0;  ///< of the squared deviation from the mean
};

/// Rounds a normal number of the given mean and variance.
///
/// Below a variance of some 0.2 it matters where between two whole numbers the mean lies, and
/// Sheppard's 1/12 is no longer what rounding adds.
RoundedNormal RoundNormal(double mean, double variance);

}  // namespace stereomotion
