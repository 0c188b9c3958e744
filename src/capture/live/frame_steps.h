#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace stereomotion {

/// Tells a camera's period from the last few steps of its clock.
class FrameSteps {
 public:
  /// Adds the time from one image to the next, `frames` numbers on.
  void Add(std::int64_t step_ns, std::int64_t frames) {
    steps_ns_[static_cast<std::size_t>(count_++ % kKept)] =
        step_ns / std::max<std::int64_t>(frames, 1);
    auto sorted = steps_ns_;
    const auto size = std::min<std::int64_t>(count_, kKept);
    std::sort(sorted.begin(), sorted.begin() + size);
    period_ns_ = sorted[static_cast<std::size_t>(size / 2)];
    shortest_ns_ = sorted[0];
  }
  void Reset() { *this = FrameSteps(); }
  [[nodiscard]] std::int64_t count() const { return count_; }
  /// The median step; 0: no step yet.
  [[nodiscard]] std::int64_t period_ns() const { return period_ns_; }
  [[nodiscard]] std::int64_t shortest_ns() const { return shortest_ns_; }

 private:
  static constexpr std::int64_t kKept = 31;
  std::array<std::int64_t, kKept> steps_ns_{};
  std::int64_t count_ = 0;
  std::int64_t period_ns_ = 0;
  std::int64_t shortest_ns_ = 0;
};

}  // namespace stereomotion
