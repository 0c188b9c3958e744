#pragma once

#include <chrono>
#include <string>

#include "src/capture/v4l2/controls.h"
#include "stereomotion/capture/camera_device.h"
#include "stereomotion/core/device_error.h"

// vivid's two virtual cameras on a real kernel: /dev/video0 (one plane), /dev/video1
// (multi-planar). The tests run in the machine that v4l2_machine_test.py starts.

namespace stereomotion::testing {

inline constexpr char kSingle[] = "v4l2:/dev/video0";
inline constexpr char kPlanar[] = "v4l2:/dev/video1";
inline constexpr std::chrono::milliseconds kWait{5000};  // the machine is emulated

inline CameraSettings Grey() {
  CameraSettings settings;
  settings.pixel_format = "GREY";
  settings.region = SensorRegion{0, 0, 640, 480};
  return settings;
}

inline std::string Problem(const CameraSettings& settings, const char* uri = kSingle) {
  try {
    const auto camera = OpenCamera(uri, settings);
    camera->Prepare();
    camera->Start();
  } catch (const DeviceError& error) {
    return error.what();
  }
  return "no error";
}

inline bool Contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// Sets a control beside the camera that streams, as another program may.
inline void Press(const char* path, const char* control, const char* value = "1") {
  const v4l2::Node node(v4l2::RunningKernel(), path);
  v4l2::Controls(node).SetByName({{control, value}});
}

}  // namespace stereomotion::testing
