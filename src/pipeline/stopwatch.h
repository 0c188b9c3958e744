#pragma once

#include <chrono>

namespace stereomotion {

/// Measures the time since it was made or last asked.
class Stopwatch {
 public:
  /// Returns the time since the last call [ms] and starts anew.
  double LapMs() {
    const auto now = Clock::now();
    const double lap_ms = std::chrono::duration<double, std::milli>(now - start_).count();
    start_ = now;
    return lap_ms;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

}  // namespace stereomotion
