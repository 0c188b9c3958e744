#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "src/capture/v4l2/v4l2_camera.h"
#include "stereomotion/core/device_error.h"
#include "tests/support/fake_v4l2.h"

namespace stereomotion::testing {

/// Whether a message holds all these parts.
inline ::testing::AssertionResult Says(const std::string& message,
                                       const std::vector<std::string>& parts) {
  for (const auto& part : parts) {
    if (message.find(part) == std::string::npos) {
      return ::testing::AssertionFailure() << "'" << message << "' lacks '" << part << "'";
    }
  }
  return ::testing::AssertionSuccess();
}

/// Whether there are so many warnings, each with its part.
inline ::testing::AssertionResult Say(const std::vector<std::string>& warnings,
                                      const std::vector<std::string>& parts) {
  if (warnings.size() != parts.size()) {
    auto failure = ::testing::AssertionFailure() << warnings.size() << " warnings:";
    for (const auto& warning : warnings) failure << "\n" << warning;
    return failure;
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (auto said = Says(warnings[i], {parts[i]}); !said) return said;
  }
  return ::testing::AssertionSuccess();
}

/// One scripted camera at /dev/video0, 8x4 pixels, and what tests do with it.
class V4l2Test : public ::testing::Test {
 protected:
  static constexpr char kUri[] = "v4l2:/dev/video0";
  static constexpr std::chrono::milliseconds kWait{10};

  V4l2Test() { kernel->devices["/dev/video0"]; }
  // Whatever a test did, nothing is left open or mapped.
  void TearDown() override { EXPECT_EQ(kernel->held(), 0); }

  FakeDevice& device() { return kernel->devices.at("/dev/video0"); }
  std::unique_ptr<CameraDevice> Open(const CameraSettings& settings = {}) {
    return OpenV4l2Camera(kUri, settings, kernel);
  }
  std::unique_ptr<CameraDevice> Run(const CameraSettings& settings = {}) {
    auto camera = Open(settings);
    camera->Prepare();
    camera->Start();
    return camera;
  }
  /// Opens, prepares and starts; gives the message of the `DeviceError` that ends it.
  std::string ErrorOf(const CameraSettings& settings = {}, const std::string& uri = kUri) {
    try {
      const auto camera = OpenV4l2Camera(uri, settings, kernel);
      camera->Prepare();
      camera->Start();
    } catch (const DeviceError& error) {
      return error.what();
    }
    return "no error";
  }
  /// Lets an image arrive whose bytes count from `first`.
  FakeImage& Arrive(std::uint32_t sequence, std::uint8_t first = 0, std::size_t bytes = 32) {
    FakeImage image;
    image.sequence = sequence;
    image.timestamp_ns = kernel->now_ns += 1'000'000;
    for (std::size_t i = 0; i < bytes; ++i) {
      image.bytes.push_back(static_cast<std::uint8_t>(first + i));
    }
    device().images.push_back(image);
    return device().images.back();
  }
  void AddControl(std::uint32_t id, const FakeControl& control) { device().controls[id] = control; }

  std::shared_ptr<FakeKernel> kernel = std::make_shared<FakeKernel>();
  DeviceFrame frame;
};

/// The same camera with a known exposure.
class V4l2StreamTest : public V4l2Test {
 protected:
  static constexpr std::int64_t kHalfExposureNs = 1'000'000;

  V4l2StreamTest() {
    AddControl(V4L2_CID_EXPOSURE_ABSOLUTE, {"Exposure", V4L2_CTRL_TYPE_INTEGER, 1, 100,
                                            kHalfExposureNs / 50'000});  // in 100 µs
  }
  DeviceEvent Next(const std::unique_ptr<CameraDevice>& camera) {
    return camera->Next(kWait, frame);
  }
};

}  // namespace stereomotion::testing
