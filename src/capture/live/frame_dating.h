#pragma once

#include <array>
#include <cstdint>

#include "camera_timeline.h"
#include "clock_pair.h"

namespace stereomotion {

/// Puts both cameras' images on one time line: the left camera's first clock. Cameras: 0 left, 1
/// right.
class FrameDating {
 public:
  explicit FrameDating(const ClockPair& clocks) : clocks_(clocks) {}

  CameraTimeline& timeline(int camera) { return timelines_[static_cast<std::size_t>(camera)]; }
  /// The camera's clock is going to be set anew.
  void StartNewClock(int camera);
  /// Numbers and dates a left image; they come in order.
  void DateLeft(const LiveFrame& frame);
  /// The same for a right image; false: no left image has come yet, so there is no time line.
  bool DateRight(const LiveFrame& frame);
  /// Host time of a left timestamp, by the least delayed arrivals.
  [[nodiscard]] std::int64_t HostTimeOf(std::int64_t timestamp_ns) const;

 private:
  [[nodiscard]] std::int64_t ShiftNs() const;

  const ClockPair& clocks_;
  std::array<CameraTimeline, 2> timelines_;
  LeftTime left_time_;
};

}  // namespace stereomotion
