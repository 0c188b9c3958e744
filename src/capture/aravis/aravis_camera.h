#pragma once

#include <memory>
#include <string>
#include <vector>

#include "stereomotion/capture/camera_device.h"

namespace stereomotion {

/// Opens a GigE Vision or USB3 Vision camera; see `OpenCamera`.
std::unique_ptr<CameraDevice> OpenAravis(const std::string& uri, const CameraSettings& settings);

/// Lists the cameras that Aravis finds, each opened for a moment to ask what it offers.
std::vector<DeviceInfo> ListAravisCameras();

}  // namespace stereomotion
