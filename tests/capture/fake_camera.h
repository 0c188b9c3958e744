#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "simulated_camera.h"
#include "stereomotion/capture/camera_device.h"

namespace stereomotion::testing {

/// Plays a simulated camera in real time: images arrive when the simulation says, with their true
/// instant in the first pixels; in an outage the camera is lost and `Reopen` fails.
class FakeCamera : public CameraDevice {
 public:
  using Clock = std::chrono::steady_clock;
  struct Options {
    std::string uri = "fake:left";
    std::string clock;  ///< what `clock()` says
    int width_px = 64, height_px = 48;
    Clock::time_point zero;           ///< host time of true time zero: alike for both cameras
    bool comes_back = true;           ///< after an outage
    std::int64_t mute_after_ns = -1;  ///< true time from which it answers but sends no image
    std::atomic<int>* triggers = nullptr;
    std::vector<Clock::time_point>* triggered = nullptr;  ///< when; one camera's own
    std::atomic<int>* opened = nullptr;                   ///< counts `Reopen`
  };

  FakeCamera(Options options, std::vector<SimulatedFrame> frames)
      : options_(std::move(options)), frames_(std::move(frames)), zero_ns_(NsOf(options_.zero)) {}

  [[nodiscard]] const std::string& uri() const override { return options_.uri; }
  [[nodiscard]] DeviceInfo info() const override {
    DeviceInfo info;
    info.uri = options_.uri;
    info.width_px = options_.width_px;
    info.height_px = options_.height_px;
    return info;
  }
  [[nodiscard]] std::string clock() const override { return options_.clock; }
  void Prepare() override {}
  void Start() override {}
  void Stop() override {}
  void Trigger() override {
    if (options_.triggers != nullptr) ++*options_.triggers;
    if (options_.triggered != nullptr) options_.triggered->push_back(Clock::now());
  }

  DeviceEvent Next(std::chrono::milliseconds at_most, DeviceFrame& frame) override {
    const auto until = Clock::now() + at_most;
    if (next_ >= frames_.size()) return Sleep(until, DeviceEvent::kNothing);
    const SimulatedFrame& coming = frames_[next_];
    if (coming.epoch > epoch_) return DeviceEvent::kLost;
    if (options_.mute_after_ns >= 0 && coming.instant_ns >= options_.mute_after_ns) {
      return Sleep(until, DeviceEvent::kNothing);
    }
    const Clock::time_point arrival = TimeOf(HostNs(coming));
    if (arrival > until) return Sleep(until, DeviceEvent::kNothing);
    std::this_thread::sleep_until(arrival);
    WriteInstant(coming.instant_ns, options_.width_px, options_.height_px, frame.image);
    frame.frame_id = coming.id;
    frame.device_ns = coming.device_ns;
    frame.host_ns = HostNs(coming);
    frame.exposure_us = 0;
    frame.epoch = epoch_;
    ++next_;
    const std::lock_guard<std::mutex> lock(mutex_);
    ++counts_.frames;
    return DeviceEvent::kFrame;
  }

  std::string Reopen() override {
    if (options_.opened != nullptr) ++*options_.opened;
    if (!options_.comes_back || Clock::now() < TimeOf(HostNs(frames_[next_]))) return "no answer";
    ++epoch_;
    const std::lock_guard<std::mutex> lock(mutex_);
    ++counts_.reopened;
    return "";
  }
  [[nodiscard]] DeviceCounts counts() const override {
    const std::lock_guard<std::mutex> lock(mutex_);
    return counts_;
  }
  [[nodiscard]] std::vector<std::string> warnings() const override { return {}; }

 private:
  static std::int64_t NsOf(Clock::time_point time) {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(time.time_since_epoch()).count();
  }
  static Clock::time_point TimeOf(std::int64_t ns) {
    return Clock::time_point(
        std::chrono::duration_cast<Clock::duration>(std::chrono::nanoseconds(ns)));
  }
  static DeviceEvent Sleep(Clock::time_point until, DeviceEvent event) {
    std::this_thread::sleep_until(until);
    return event;
  }
  [[nodiscard]] std::int64_t HostNs(const SimulatedFrame& frame) const {
    return frame.host_ns - kHostAtZeroNs + zero_ns_;
  }

  Options options_;
  std::vector<SimulatedFrame> frames_;
  std::int64_t zero_ns_;
  std::size_t next_ = 0;
  int epoch_ = 0;
  mutable std::mutex mutex_;
  DeviceCounts counts_;
};

}  // namespace stereomotion::testing
