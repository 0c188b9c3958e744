#include "frame_counter.h"

namespace stereomotion {
namespace {

constexpr std::uint64_t kLargest16 = 0xFFFF;
constexpr std::uint64_t kLargest32 = 0xFFFFFFFF;

// How many numbers there are before they start again; 0: they never do.
std::uint64_t NumbersInAll(std::uint64_t last, bool has_zero) {
  if (last > kLargest32) return 0;
  const std::uint64_t largest = last > kLargest16 ? kLargest32 : kLargest16;
  return has_zero ? largest + 1 : largest;
}

}  // namespace

std::int64_t FrameCounter::Next(std::uint64_t number) {
  has_zero_ = has_zero_ || number == 0;
  std::uint64_t step = number - last_;
  if (!started_) {
    unwrapped_ = static_cast<std::int64_t>(number);
    step = 0;
  } else if (number <= last_) {
    const std::uint64_t all = NumbersInAll(last_, has_zero_);
    step = all == 0 ? 0 : number + all - last_;
    if (all == 0 || step > all / 2) {  // more lost than not: the camera began to count anew
      ++restarts_;
      step = 1;
    }
  }
  started_ = true;
  last_ = number;
  unwrapped_ += static_cast<std::int64_t>(step);
  return unwrapped_;
}

DeviceClock::DeviceClock(std::uint64_t tick_hz) {
  constexpr double kTicks = 4294967296.0;  // 2^32
  constexpr double kNsPerS = 1e9;
  if (tick_hz > 0) {
    range_ns_ = static_cast<std::int64_t>(kTicks * kNsPerS / static_cast<double>(tick_hz));
  }
}

bool DeviceClock::Next(std::int64_t device_ns, std::int64_t& unwrapped_ns) {
  const bool back = started_ && device_ns <= last_ns_;
  // A bad time stamp, not another clock: whoever compares it with the one before drops the image.
  constexpr std::int64_t kSetBackNs = 1'000'000;  // as of `CameraTimeline`
  if (back && last_ns_ - device_ns <= kSetBackNs) {
    unwrapped_ns = device_ns + offset_ns_;
    return true;
  }
  // From the last eighth of 32 bits into the first: a wrap. Any other way back is a new time.
  const bool wrapped = back && range_ns_ > 0 && last_ns_ <= range_ns_ &&
                       last_ns_ > range_ns_ / 8 * 7 && device_ns < range_ns_ / 8;
  if (wrapped) offset_ns_ += range_ns_;
  if (back && !wrapped) offset_ns_ = 0;
  started_ = true;
  last_ns_ = device_ns;
  unwrapped_ns = device_ns + offset_ns_;
  return !back || wrapped;
}

}  // namespace stereomotion
