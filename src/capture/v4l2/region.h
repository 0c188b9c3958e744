#pragma once

#include <string>
#include <vector>

#include "node.h"
#include "stereomotion/core/camera_settings.h"

namespace stereomotion::v4l2 {

/// Crops the sensor (VIDIOC_S_SELECTION). Where the driver cannot, a region at (0, 0) is taken for
/// the size of the whole image, with a warning. Throws `DeviceError`.
void SetRegion(const Node& node, const SensorRegion& region, std::vector<std::string>& warnings);

/// Makes sure that the region is still the one that was set, and is not scaled: a driver may move
/// it when the size is set. Throws `DeviceError`.
void CheckRegion(const Node& node, const SensorRegion& region);

}  // namespace stereomotion::v4l2
