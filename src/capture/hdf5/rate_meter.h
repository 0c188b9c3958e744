#pragma once

#include <cmath>
#include <cstdint>

#include "../ring_recorder.h"

namespace stereomotion {

/// Finds how many frames a second come.
class RateMeter {
 public:
  void Add(const RingItem& item) {
    const Frame& frame = item.frames[0] ? *item.frames[0] : *item.frames[1];
    if (count_++ == 0) first_ns_ = frame.timestamp_ns;
    last_ns_ = frame.timestamp_ns;
  }
  /// Frames in `seconds`; 0: not known.
  [[nodiscard]] std::int64_t FramesIn(double seconds) const {
    constexpr double kSecondsPerNs = 1e-9;
    const double elapsed_s = static_cast<double>(last_ns_ - first_ns_) * kSecondsPerNs;
    if (count_ < 2 || !(elapsed_s > 0)) return 0;
    return std::llround(static_cast<double>(count_ - 1) / elapsed_s * seconds);
  }

 private:
  std::int64_t count_ = 0, first_ns_ = 0, last_ns_ = 0;
};

}  // namespace stereomotion
