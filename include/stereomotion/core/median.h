#pragma once

#include <algorithm>
#include <vector>

namespace stereomotion {

/// Finds the median (the upper one of an even number) and reorders the values; 0 of an empty list.
inline double MedianInPlace(std::vector<double>& values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Finds the median (the upper one of an even number); 0 of an empty list.
inline double Median(std::vector<double> values) { return MedianInPlace(values); }

}  // namespace stereomotion
