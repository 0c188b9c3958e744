#include "stream.h"

#include <linux/videodev2.h>
#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <limits>

#include "fourcc.h"

namespace stereomotion::v4l2 {
namespace {

constexpr std::int64_t kBeforeAll = std::numeric_limits<std::int64_t>::min();

// As many as come while the program is held up for so long, within what drivers take
// (VIDEO_MAX_FRAME) and what memory allows.
std::uint32_t BufferCount(double rate_hz, std::uint32_t image_bytes) {
  constexpr double kHeldUp_s = 0.15;
  constexpr double kFewest = 4;
  constexpr double kMostBytes = 256 << 20;
  const double for_rate = std::max(kFewest, std::ceil(rate_hz * kHeldUp_s) + 1);
  const double for_memory = std::max(kFewest, kMostBytes / std::max(1U, image_bytes));
  return static_cast<std::uint32_t>(
      std::min({for_rate, for_memory, static_cast<double>(VIDEO_MAX_FRAME)}));
}

}  // namespace

Stream::Stream(const Node& node, const StreamFormat& format, double rate_hz,
               TimestampPoint timestamp_at, double exposure_us)
    : node_(node),
      format_(format),
      pixel_format_(PixelFormatOf(format.fourcc)),
      exposure_us_(exposure_us),
      buffers_(node, BufferCount(rate_hz, format.buffer_bytes)),
      times_(buffers_.timestamp_flags(), timestamp_at, exposure_us),
      last_ns_(kBeforeAll) {}

Stream::~Stream() { Stop(); }

void Stream::Start() {
  buffers_.QueueAll();
  int type = static_cast<int>(node_.buffer_type());
  node_.Call(VIDIOC_STREAMON, &type, "start the stream", "VIDIOC_STREAMON");
  on_ = true;
}

void Stream::Stop() {
  if (!on_) return;
  on_ = false;
  int type = static_cast<int>(node_.buffer_type());
  node_.Try(VIDIOC_STREAMOFF, &type);  // fails where the camera is gone: it is off then
}

DeviceEvent Stream::Lost(const char* call, int error, std::string& problem) {
  problem = std::string("the camera was lost (") + call + "): " + ErrorText(error);
  return DeviceEvent::kLost;
}

DeviceEvent Stream::Next(std::chrono::milliseconds at_most, DeviceFrame& frame,
                         DeviceCounts& counts, std::string& problem) {
  if (!on_) return Lost("not started", ENODEV, problem);
  if (broken_ != 0) return Lost("VIDIOC_QBUF", broken_, problem);
  const int events = node_.Wait(at_most);
  if (events == 0) return DeviceEvent::kNothing;
  if (events < 0) return Lost("poll", -events, problem);
  FilledBuffer filled;
  const int error = buffers_.Dequeue(filled);
  const bool gone = (events & (POLLERR | POLLHUP | POLLNVAL)) != 0;
  if (error == EAGAIN && !gone) return DeviceEvent::kNothing;
  if (error != 0) return Lost("VIDIOC_DQBUF", error == EAGAIN ? EIO : error, problem);
  const DeviceEvent event = Use(filled, node_.kernel().NowNs(), frame, problem);
  broken_ = buffers_.Queue(filled.index);
  if (event == DeviceEvent::kFrame) {
    frame.frame_id = numbers_.Next(filled.sequence, dropped_);
    dropped_ = 0;
    counts.lost = numbers_.lost();
    ++counts.frames;
    if (!numbers_.counts() && !told_) {
      told_ = true;
      problem = "its driver does not number the images one after the other: lost ones are not seen";
    }
  } else {
    ++dropped_;
    ++counts.incomplete;
  }
  return event;
}

DeviceEvent Stream::Use(const FilledBuffer& filled, std::int64_t arrival_ns, DeviceFrame& frame,
                        std::string& problem) {
  if ((filled.flags & V4L2_BUF_FLAG_ERROR) != 0 || filled.bytes == 0) {
    return DeviceEvent::kIncomplete;
  }
  const auto middle_ns = times_.MidExposureNs(filled.timestamp_ns, arrival_ns);
  if (!middle_ns) {
    problem =
        "timestamps are not of the monotonic clock as the driver says, such images are "
        "dropped; for USB cameras: `sudo modprobe uvcvideo clock=CLOCK_MONOTONIC`";
    return DeviceEvent::kIncomplete;
  }
  if (*middle_ns <= last_ns_) {
    problem =
        "sends images whose time does not advance; they are dropped, as they may be the same "
        "image again";
    return DeviceEvent::kIncomplete;
  }
  ImageLayout layout = format_.layout;
  layout.bytes = filled.bytes;
  const std::string why = ConvertToGrey(filled.data, pixel_format_, layout, frame.image);
  if (!why.empty()) {
    problem = "sends damaged images, which are dropped: " + why;
    return DeviceEvent::kIncomplete;
  }
  last_ns_ = *middle_ns;
  frame.device_ns = *middle_ns;
  frame.host_ns = times_.FirstByteNs(*middle_ns, arrival_ns);
  frame.exposure_us = exposure_us_;
  return DeviceEvent::kFrame;
}

}  // namespace stereomotion::v4l2
