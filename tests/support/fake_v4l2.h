#pragma once

#include <linux/videodev2.h>

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "src/capture/v4l2/kernel.h"

namespace stereomotion::testing {

/// A control of the scripted camera.
struct FakeControl {
  std::string name;
  std::uint32_t type = V4L2_CTRL_TYPE_INTEGER;
  std::int64_t lowest = 0, highest = 255, value = 0;
  std::uint32_t flags = 0;
  std::map<std::int64_t, std::string> menu{};  ///< of V4L2_CTRL_TYPE_INTEGER_MENU: numbers
  std::int64_t keeps = -1;                     ///< takes this value whatever is set; −1: obeys
};

/// An image that the scripted camera will deliver.
struct FakeImage {
  std::vector<std::uint8_t> bytes;
  std::uint32_t sequence = 0;
  std::int64_t timestamp_ns = 0;
  std::uint32_t flags = 0;
};

/// A scripted camera. Change it while it is used, as a person does who pulls the plug.
struct FakeDevice {
  std::string driver = "fake", card = "Fake camera", bus = "usb-1";
  std::uint32_t capabilities = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
  std::vector<std::uint32_t> formats{V4L2_PIX_FMT_YUYV, V4L2_PIX_FMT_GREY};
  std::vector<std::pair<int, int>> sizes{{8, 4}, {4, 2}};  ///< the last is taken for all others
  std::vector<double> rates_hz{30, 60};                    ///< the last is taken for all others
  bool has_rate = true, crops = false;
  std::uint32_t fourcc = V4L2_PIX_FMT_YUYV;
  int width = 8, height = 4;
  int padding_bytes = 0;  ///< at the end of each row
  std::uint32_t planes = 1, plane_offset = 0, field = V4L2_FIELD_NONE;
  double rate_hz = 30;
  v4l2_rect crop{0, 0, 8, 4};
  std::map<std::uint32_t, FakeControl> controls;
  std::uint32_t timestamp_flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  std::uint32_t most_buffers = 32;
  std::deque<FakeImage> images;
  int poll_events = -1;  ///< what poll says, whatever waits; −1: the truth

  // What the camera saw.
  std::vector<std::vector<std::uint8_t>> memory;
  std::deque<std::uint32_t> queued;
  bool streaming = false;
  int maps = 0;  ///< still mapped
  std::uint32_t buffers_asked = 0;
};

/// A kernel with scripted cameras and failures.
class FakeKernel : public v4l2::Kernel {
 public:
  std::map<std::string, FakeDevice> devices;
  /// errno for the next calls, by request (VIDIOC_…); one a call.
  std::map<std::uint64_t, std::deque<int>> failures;
  std::deque<int> open_failures, map_failures, poll_failures;
  std::int64_t now_ns = 5'000'000'000;

  int Open(const std::string& path) override;
  void Close(int descriptor) override;
  int Control(int descriptor, std::uint64_t request, void* argument) override;
  void* Map(int descriptor, std::size_t bytes, std::int64_t offset, int& error) override;
  void Unmap(void* memory, std::size_t bytes) override;
  int Poll(int descriptor, int at_most_ms) override;
  std::vector<std::string> VideoNodes() override;
  std::int64_t NowNs() override { return now_ns; }

  /// Counts the files and buffers that were not given back.
  [[nodiscard]] std::size_t held() const { return open_.size() + mapped_.size(); }

 private:
  std::map<int, std::string> open_;
  std::map<void*, std::string> mapped_;
  int next_ = 3;
};

}  // namespace stereomotion::testing
