#pragma once

#include <cstdint>

namespace stereomotion {

/// Makes frame numbers that start again (16 bit with 0 or, as GigE Vision says, without it; 32 bit;
/// 64 bit never does) rise for ever.
class FrameCounter {
 public:
  /// Gives the unwrapped number of the next frame, lost ones in between counted.
  std::int64_t Next(std::uint64_t number);
  /// Counts how often the numbers jumped back with no wrap that could explain it.
  [[nodiscard]] std::int64_t restarts() const { return restarts_; }

 private:
  bool started_ = false;
  bool has_zero_ = false;
  std::uint64_t last_ = 0;
  std::int64_t unwrapped_ = 0;
  std::int64_t restarts_ = 0;
};

/// Makes the time of a camera whose counter has 32 bits rise for ever.
class DeviceClock {
 public:
  /// `tick_hz`: of the counter; 0: not known, or it has 64 bits anyway.
  explicit DeviceClock(std::uint64_t tick_hz = 0);
  /// Gives the unwrapped time. False where it went back by more than a millisecond: then the clock
  /// was set anew. By less, or where it stands still, it is given as it is.
  bool Next(std::int64_t device_ns, std::int64_t& unwrapped_ns);

 private:
  std::int64_t range_ns_ = 0;
  std::int64_t last_ns_ = 0;
  std::int64_t offset_ns_ = 0;
  bool started_ = false;
};

}  // namespace stereomotion
