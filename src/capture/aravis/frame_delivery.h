#pragma once

#include <cstdint>
#include <mutex>
#include <optional>

#include "frame_counter.h"
#include "raw_frame.h"
#include "stereomotion/capture/camera_device.h"

namespace stereomotion {

/// Numbers, dates and counts the images of a camera. `counts` is safe from any thread.
class FrameDelivery {
 public:
  /// Starts counting gaps anew: numbers before and after are not comparable.
  void Restart(std::uint64_t tick_hz);
  /// Fills all of `frame` but its image. False where the camera's clock went back.
  bool Deliver(const RawFrame& raw, DeviceFrame& frame);
  /// Counts an image that is not used.
  void Drop(std::int64_t DeviceCounts::*counter);
  /// Takes over what the stream counted so far.
  void CountStream(const StreamCounts& now);
  /// Says that the next stream counts from 0.
  void StreamEnds();
  void CountReopened();
  [[nodiscard]] DeviceCounts counts() const;

 private:
  void CountFrame(std::int64_t number);

  FrameCounter numbers_;
  DeviceClock clock_;
  std::optional<std::int64_t> last_number_;
  std::int64_t dropped_since_ = 0;  // images that came after `last_number_` and were not used
  bool underrun_since_ = false;
  StreamCounts counted_;
  mutable std::mutex mutex_;  // of counts_
  DeviceCounts counts_;
};

}  // namespace stereomotion
