#include "camera_timeline.h"

#include <algorithm>
#include <cstdlib>

namespace stereomotion {
namespace {

/// No delay explains a greater step of a clock forward; backward it takes less.
constexpr std::int64_t kSetForwardNs = 1'000'000'000;
constexpr std::int64_t kSetBackwardNs = 1'000'000;

}  // namespace

Succession CameraTimeline::Admit(const LiveFrame& frame) {
  step_frames_ = 0;
  auto succession = Succession::kNext;
  if (has_frame_ && frame.epoch != last_.epoch) {
    succession = Succession::kNewClock;
    set_within_ = false;
  } else if (has_frame_) {
    const std::int64_t step_ns = frame.device_ns - last_.device_ns;
    const std::int64_t host_step_ns = frame.host_ns - last_.host_ns;
    // Forward: the image would have come before it was taken. Backward by less is a bad timestamp.
    const bool is_set = step_ns < -kSetBackwardNs || step_ns > host_step_ns + kSetForwardNs;
    if (is_set) {
      succession = Succession::kNewClock;
      set_within_ = true;
    } else if (step_ns <= 0) {
      return Succession::kMisdated;
    } else {
      step_ns_ = step_ns;
      step_frames_ = std::max<std::int64_t>(1, frame.frame_id - last_.frame_id);
    }
  }
  has_frame_ = true;
  last_ = {nullptr, frame.frame_id, frame.device_ns, frame.host_ns, frame.epoch};
  return succession;
}

void CameraTimeline::Stamp(const LiveFrame& frame, std::int64_t timestamp_ns,
                           std::int64_t period_ns) {
  std::int64_t next_index = last_index_ + 1;
  if (last_index_ >= 0) timestamp_ns = std::max(timestamp_ns, last_timestamp_ns_ + 1);
  if (!numbered_ || frame.epoch != stamped_epoch_) {
    if (last_index_ >= 0 && period_ns > 0) {
      const std::int64_t missed = (timestamp_ns - last_timestamp_ns_ + period_ns / 2) / period_ns;
      next_index = last_index_ + std::max<std::int64_t>(1, missed);
    }
    index_minus_id_ = next_index - frame.frame_id;
    stamped_epoch_ = frame.epoch;
    numbered_ = true;
  }
  last_index_ = std::max(last_index_ + 1, frame.frame_id + index_minus_id_);
  last_timestamp_ns_ = timestamp_ns;
  frame.frame->index = last_index_;
  frame.frame->timestamp_ns = timestamp_ns;
  frame.frame->device_ns = frame.device_ns;
}

void LeftTime::EndEpoch(const ClockLine& line) {
  if (!fixed_) return;  // nothing was dated by the epoch that ends
  before_ = line;
  fixed_ = false;
}

std::int64_t LeftTime::ShiftBy(const ClockLine& line, std::int64_t period_ns) const {
  if (fixed_) return shift_ns_;
  const std::int64_t device_ns = line.device_ns;
  const std::int64_t host_ns = device_ns + line.HostMinusDevice(device_ns);
  const std::int64_t about_ns = host_ns - before_.HostMinusDevice(before_.device_ns);
  const std::int64_t in_old_ns = host_ns - before_.HostMinusDevice(about_ns);
  const std::int64_t change_ns = in_old_ns - device_ns;
  // A clock that agrees with itself was not set: it went on while the connection was lost.
  return std::llabs(change_ns) < period_ns / 4 ? shift_ns_ : shift_ns_ + change_ns;
}

void LeftTime::Fix(std::int64_t shift_ns) {
  shift_ns_ = shift_ns;
  fixed_ = true;
}

}  // namespace stereomotion
