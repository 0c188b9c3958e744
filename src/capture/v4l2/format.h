#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "../pixel_formats.h"
#include "node.h"
#include "stereomotion/core/camera_settings.h"

namespace stereomotion::v4l2 {

/// The images that a device sends, as the driver and we agreed.
struct StreamFormat {
  std::uint32_t fourcc = 0;
  ImageLayout layout;              ///< `bytes`: not known before an image is there
  std::uint32_t buffer_bytes = 0;  ///< what the driver needs for one
  std::uint32_t field = 0;         ///< V4L2_FIELD_…
};

/// Reads the format in force. Throws `DeviceError`.
StreamFormat CurrentFormat(const Node& node);

/// Sets pixel format and size or region of interest; what is not given stays as the device has it,
/// or is as it was `before` a reconnection (may be null). Throws `DeviceError` where the driver
/// offers something else; what it changed silently is an error too: the rig was calibrated for one
/// size.
StreamFormat AgreeOnFormat(const Node& node, const CameraSettings& settings,
                           const StreamFormat* before, std::vector<std::string>& warnings);

/// Reads the frame rate in force; 0: the driver does not say.
double CurrentRateHz(const Node& node);

/// Sets the frame rate. Throws `DeviceError` where the driver has none, or takes another one.
double AgreeOnRate(const Node& node, const StreamFormat& format, double rate_hz);

}  // namespace stereomotion::v4l2
