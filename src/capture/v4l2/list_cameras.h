#pragma once

#include "node.h"
#include "stereomotion/capture/camera_device.h"

namespace stereomotion::v4l2 {

/// Describes an opened camera with the settings in force.
DeviceInfo Describe(const Node& node);

}  // namespace stereomotion::v4l2
