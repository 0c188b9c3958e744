#pragma once

#include <memory>
#include <string>
#include <vector>

#include "kernel.h"
#include "stereomotion/capture/camera_device.h"

namespace stereomotion {

/// Opens "v4l2:/dev/video0" (or a link to it: "v4l2:/dev/v4l/by-id/…", which stays when the numbers
/// change) and applies the settings. Throws as `OpenCamera` does.
std::unique_ptr<CameraDevice> OpenV4l2Camera(
    const std::string& uri, const CameraSettings& settings,
    std::shared_ptr<v4l2::Kernel> kernel = v4l2::RunningKernel());

/// Lists the devices that capture images, with those that cannot be opened.
std::vector<DeviceInfo> ListV4l2Cameras(
    const std::shared_ptr<v4l2::Kernel>& kernel = v4l2::RunningKernel());

}  // namespace stereomotion
