#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "buffers.h"
#include "format.h"
#include "frame_times.h"
#include "stereomotion/capture/camera_device.h"

namespace stereomotion::v4l2 {

/// Takes the images of one opened device: its buffers, switched on and off, and what each image's
/// numbers and times mean. Stops and gives the buffers back when it ends.
class Stream {
 public:
  /// Creates the buffers. Throws `DeviceError`.
  Stream(const Node& node, const StreamFormat& format, double rate_hz, TimestampPoint timestamp_at,
         double exposure_us);
  ~Stream();
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  [[nodiscard]] bool monotonic() const { return times_.monotonic(); }
  /// Throws `DeviceError`.
  void Start();
  void Stop();
  /// As `CameraDevice::Next`; adds to `counts`; `problem` is set with `kLost`, and with
  /// `kIncomplete` where there is more to say than that bytes lack.
  DeviceEvent Next(std::chrono::milliseconds at_most, DeviceFrame& frame, DeviceCounts& counts,
                   std::string& problem);

 private:
  DeviceEvent Use(const FilledBuffer& filled, std::int64_t arrival_ns, DeviceFrame& frame,
                  std::string& problem);
  DeviceEvent Lost(const char* call, int error, std::string& problem);

  const Node& node_;
  StreamFormat format_;
  PixelFormat pixel_format_;
  double exposure_us_;
  Buffers buffers_;
  FrameTimes times_;
  SequenceCounter numbers_;
  std::int64_t last_ns_;
  std::int64_t dropped_ = 0;  // since the last image that was used
  int broken_ = 0;            // errno of a buffer that could not be handed back
  bool told_ = false;         // that the driver does not count
  bool on_ = false;
};

}  // namespace stereomotion::v4l2
