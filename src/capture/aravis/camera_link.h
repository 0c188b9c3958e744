#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
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
  [[nodiscard]] bool lost() const { return *lost_; }

 private:
  using Flag = std::shared_ptr<std::atomic<bool>>;
  static void OnLost(ArvDevice* device, gpointer flag);
  static void Forget(gpointer flag, GClosure* closure);

  ArvDevice* device_;
  gulong handler_ = 0;
  Flag lost_ = std::make_shared<std::atomic<bool>>(false);
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

/// Says what a camera is waited for and which one it has to be.
struct Expectation {
  std::chrono::milliseconds patience{0};  ///< for another program to give it up
  std::string id;                         ///< as of `DeviceIdOf`; empty: any
};

/// Opens and sets a camera; adds to `warnings`. Throws `DeviceError`, also where another camera
/// answers than is expected: nothing is set in that one.
CameraLink OpenLink(const std::string& name, const std::string& uri, const CameraSettings& settings,
                    const Expectation& expected, std::vector<std::string>& warnings);

/// Stops the images. False: the camera does not answer; let go of it then.
bool StopAcquisition(ArvCamera* camera);

/// Stops and lets go of a camera. Waits for that where the camera `answers`, but not for long: one
/// that is dead Aravis asks politely several times, 15 s in all. That goes on in the background,
/// because meanwhile the camera may be back, or the program is to end.
void CloseLink(CameraLink link, bool answers = true);

}  // namespace stereomotion
