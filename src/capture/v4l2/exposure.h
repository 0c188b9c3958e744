#pragma once

#include <string>
#include <vector>

#include "node.h"
#include "stereomotion/core/camera_settings.h"

namespace stereomotion::v4l2 {

/// Sets exposure, gain and the other controls, in that order; returns the exposure in force [µs],
/// 0: not known or not constant. Throws `DeviceError` where the camera cannot.
double ApplyControls(const Node& node, const CameraSettings& settings,
                     std::vector<std::string>& warnings);

}  // namespace stereomotion::v4l2
