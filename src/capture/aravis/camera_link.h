#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <future>
#include <memory>
#include <string>
#include <vector>

#include "action_command.h"
#include "gobject.h"
#include "image_stream.h"
#include "stereomotion/capture/camera_device.h"

namespace stereomotion {

/// Notes that a camera said goodbye or was silent for 5 s; told by a thread of Aravis.
class ControlWatch {
 public:
  explicit ControlWatch(ArvCamera* camera);
  ~ControlWatch();
  ControlWatch(const ControlWatch&) = delete;
  ControlWatch& operator=(const ControlWatch&) = delete;
  [[nodiscard]] bool lost() const { return lost_; }

 private:
  static void OnLost(ArvDevice* device, gpointer self);

  ArvDevice* device_;
  gulong handler_ = 0;
  std::atomic<bool> lost_{false};
};

/// An opened and set camera with its stream; what has to be made anew when it was lost.
struct CameraLink {
  GObjectPtr<ArvCamera> camera;
  std::unique_ptr<ControlWatch> watch;
  std::unique_ptr<ImageStream> stream;
  AgreedFormat agreed;
  DeviceInfo info;
  double exposure_us = 0;    ///< 0: unknown, or the camera changes it by itself
  bool free_running = true;  ///< by the camera's own clock: images come without a trigger
  std::uint64_t tick_hz = 0;
  ActionKeys action_keys;
  std::string id, address;
};

/// Opens and sets a camera; adds to `warnings`. Throws `DeviceError`.
CameraLink OpenLink(const std::string& name, const std::string& uri, const CameraSettings& settings,
                    std::chrono::milliseconds patience, std::vector<std::string>& warnings);

/// Lets go of cameras. One that does not answer any more is let go in the background: Aravis asks
/// it politely several times, 8 s in all, and meanwhile it may be back. The destructor waits for
/// that.
class LinkCloser {
 public:
  void Close(CameraLink link);

 private:
  std::vector<std::future<void>> closing_;
};

}  // namespace stereomotion
