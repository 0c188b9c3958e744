#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "frame_pool.h"
#include "live_inbox.h"
#include "stereomotion/capture/camera_device.h"
#include "stereomotion/capture/live_pairs.h"
#include "stop_signal.h"

namespace stereomotion {

/// Receives the images of one camera, brings it back when it is lost, and triggers it. Its `Run` is
/// a thread's; the camera is used by that thread alone, but for its `counts`.
class CameraReceiver {
 public:
  using Clock = std::chrono::steady_clock;
  /// Ends the whole stream: why in a word, and what went wrong, for a person.
  using End = std::function<void(const std::string& why, const std::string& problem)>;

  CameraReceiver(int camera, std::unique_ptr<CameraDevice> device, const LiveOptions& options,
                 LiveInbox& inbox, const StopSignal& stop, End end);

  /// The camera; before `Run` and after it only.
  CameraDevice& device() { return *device_; }
  /// Receives until the stop signal; triggers count from `start`.
  void Run(Clock::time_point start);
  [[nodiscard]] LiveCameraReport report() const;
  [[nodiscard]] std::vector<std::string> warnings() const;
  /// Host time at which its first image came; 0: none yet.
  [[nodiscard]] std::int64_t first_host_ns() const;

 private:
  void Loop();
  DeviceEvent WaitForImage();
  void TakeFrame();
  void CheckFirstImage();
  void BringBack(std::string why);
  bool KeepTrying(std::string& why);
  bool TryToReopen(std::string& why);
  void SendTriggers();
  void NoteDevice();

  int camera_;
  std::unique_ptr<CameraDevice> device_;
  LiveOptions options_;
  LiveInbox& inbox_;
  const StopSignal& stop_;
  End end_;
  FramePool pool_;
  DeviceFrame received_;
  Clock::time_point start_, next_trigger_, next_note_;
  Clock::time_point lost_at_, reopened_at_;
  bool awaits_return_ = false;  ///< reopened, but no image has come yet

  mutable std::mutex mutex_;  ///< of what follows
  DeviceInfo info_;
  std::vector<std::string> warnings_;
  std::int64_t frames_ = 0, first_host_ns_ = 0, last_host_ns_ = 0;
  Clock::duration down_{};
  Clock::time_point down_since_;
  bool is_down_ = false;
};

}  // namespace stereomotion
