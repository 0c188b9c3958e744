#include "frame_delivery.h"

#include <algorithm>

namespace stereomotion {

void FrameDelivery::Restart(std::uint64_t tick_hz) {
  numbers_ = FrameCounter();
  clock_ = DeviceClock(tick_hz);
  last_number_.reset();
  dropped_since_ = 0;
  underrun_since_ = false;
}

bool FrameDelivery::Deliver(const RawFrame& raw, DeviceFrame& frame) {
  frame.frame_id = numbers_.Next(raw.number);
  frame.host_ns = raw.host_ns;
  CountFrame(frame.frame_id);
  return clock_.Next(raw.device_ns, frame.device_ns);
}

void FrameDelivery::Drop(std::int64_t DeviceCounts::*counter) {
  ++dropped_since_;
  const std::lock_guard lock(mutex_);
  ++(counts_.*counter);
}

// Numbers that are missing are images without a buffer, if packets found none; else lost.
void FrameDelivery::CountFrame(std::int64_t number) {
  const std::lock_guard lock(mutex_);
  ++counts_.frames;
  if (last_number_) {
    const std::int64_t missing =
        std::max<std::int64_t>(0, number - *last_number_ - 1 - dropped_since_);
    (underrun_since_ ? counts_.underruns : counts_.lost) += missing;
  }
  last_number_ = number;
  dropped_since_ = 0;
  underrun_since_ = false;
}

void FrameDelivery::CountStream(const StreamCounts& now) {
  underrun_since_ = underrun_since_ || now.underruns > counted_.underruns;
  const std::lock_guard lock(mutex_);
  counts_.resent_packets += static_cast<std::int64_t>(now.resent_packets - counted_.resent_packets);
  counted_ = now;
}

void FrameDelivery::StreamEnds() { counted_ = {}; }

void FrameDelivery::CountReopened() {
  const std::lock_guard lock(mutex_);
  ++counts_.reopened;
}

DeviceCounts FrameDelivery::counts() const {
  const std::lock_guard lock(mutex_);
  return counts_;
}

}  // namespace stereomotion
