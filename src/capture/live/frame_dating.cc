#include "frame_dating.h"

namespace stereomotion {

void FrameDating::StartNewClock(int camera) {
  if (camera == 0) left_time_.EndEpoch(clocks_.line(0));
}

std::int64_t FrameDating::ShiftNs() const {
  return left_time_.ShiftBy(clocks_.line(0), clocks_.period_ns());
}

void FrameDating::DateLeft(const LiveFrame& frame) {
  left_time_.Fix(ShiftNs());
  timelines_[0].Stamp(frame, frame.device_ns + ShiftNs(), clocks_.period_ns());
}

bool FrameDating::DateRight(const LiveFrame& frame) {
  const auto offset_ns = clocks_.BestOffsetAt(frame.device_ns);
  if (!offset_ns) return false;
  const std::int64_t timestamp_ns = frame.device_ns + *offset_ns + ShiftNs();
  timelines_[1].Stamp(frame, timestamp_ns, clocks_.period_ns());
  return true;
}

std::int64_t FrameDating::HostTimeOf(std::int64_t timestamp_ns) const {
  const std::int64_t device_ns = timestamp_ns - ShiftNs();
  return device_ns + clocks_.line(0).HostMinusDevice(device_ns);
}

}  // namespace stereomotion
