#pragma once

#include <cmath>
#include <cstdint>

namespace stereomotion {

/// Draws numbers that depend on nothing but (seed, stream, counter): SplitMix64's finaliser over
/// the three (Steele et al. 2014), so that any pixel can be drawn alone and in any order.
class CounterRng {
 public:
  CounterRng(std::uint64_t seed, std::uint64_t stream, std::uint64_t counter)
      : state_(Mix(Mix(Mix(seed + kStep) + stream * kStep) + counter * kStep)) {}

  /// Draws uniformly from (0, 1), neither end included.
  double Uniform() {
    state_ += kStep;
    return (static_cast<double>(Mix(state_) >> 11) + 0.5) * 0x1.0p-53;
  }

  /// Draws a standard normal number (Box–Muller, of which only one is kept).
  double Normal() {
    const double radius = std::sqrt(-2 * std::log(Uniform()));
    return radius * std::cos(2 * M_PI * Uniform());
  }

 private:
  static constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15ULL;
  static std::uint64_t Mix(std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
    return x ^ (x >> 31);
  }
  std::uint64_t state_;
};

}  // namespace stereomotion
