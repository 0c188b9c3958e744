#pragma once

#include <cstdint>

namespace stereomotion {

constexpr double kSecondsPerNs = 1e-9;
/// For what a person reads; all else is in radians.
constexpr double kDegreesPerRadian = 57.29577951308232;

/// Gives the time between two device times; their difference is taken in integers.
inline double SecondsBetween(std::int64_t from_ns, std::int64_t to_ns) {
  return static_cast<double>(to_ns - from_ns) * kSecondsPerNs;
}

}  // namespace stereomotion
