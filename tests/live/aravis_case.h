#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "stereomotion/capture/camera_device.h"
#include "stereomotion/core/device_error.h"
#include "tests/support/gv_images.h"
#include "tests/support/gv_process.h"
#include "tests/support/own_network.h"

namespace stereomotion::testing {

/// Test of cameras that a process beside this one serves, in a network of their own.
class AravisCase : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    static const std::string why = EnterOwnNetwork();  // once a process: it cannot go back
    refused_ = why;
  }
  void SetUp() override {
    if (!refused_.empty()) GTEST_SKIP() << refused_;
  }

  static std::unique_ptr<GvProcess> Serve(const std::vector<std::string>& arguments) {
    return std::make_unique<GvProcess>(STEREOMOTION_GV_SERVER, arguments);
  }

  /// The message of the error that opening gives; empty where it opens.
  static std::string ErrorOf(const std::string& uri, const CameraSettings& settings = {}) {
    try {
      OpenCamera(uri, settings);
    } catch (const DeviceError& error) {
      return error.what();
    }
    return "";
  }

  /// Waits for an event of that kind, at most so long.
  static bool WaitFor(CameraDevice& camera, DeviceEvent wanted, DeviceFrame& frame,
                      std::chrono::seconds at_most = std::chrono::seconds(20)) {
    const auto end = std::chrono::steady_clock::now() + at_most;
    constexpr std::chrono::milliseconds kStep(200);
    while (std::chrono::steady_clock::now() < end) {
      if (camera.Next(kStep, frame) == wanted) return true;
    }
    return false;
  }

 private:
  inline static std::string refused_;
};

/// The true time that `--stamp` has put into an image [µs].
inline std::int64_t StampOf(const Image& image) {
  std::int64_t stamp_us = 0;
  std::memcpy(&stamp_us, image.View().data, sizeof stamp_us);
  return stamp_us;
}

/// Whether a stamped image of the synthetic pattern is, byte by byte, that of its stamp.
inline bool IsWhatWasSent(const Image& image, const std::string& camera, double rate_hz) {
  GvPlan plan;
  plan.rate_hz = rate_hz;
  const int place = GvImageAt(plan, StampOf(image), kGvSyntheticImages);
  const ImageView view = image.View();
  for (int v = 0; v < view.height_px; ++v) {
    const auto* row = view.Row<std::uint8_t>(v);
    for (int u = v == 0 ? static_cast<int>(sizeof(std::int64_t)) : 0; u < view.width_px; ++u) {
      if (row[u] != GvSyntheticByte(camera, place, u, v)) return false;
    }
  }
  return !view.empty();
}

}  // namespace stereomotion::testing
