#pragma once

#include <string>

#include "frame_matcher.h"
#include "stereomotion/capture/live_report.h"

namespace stereomotion {

/// Says why no image came, and what to do.
std::string NoImagesText(const std::string& uri, const DeviceCounts& counts, double waited_s);

/// Says that a lost camera did not come back.
std::string CameraLostText(const std::string& uri, const std::string& why, double waited_s);

/// Fills in how the images were put together, and what a person should know of it; the cameras'
/// names stand in the report.
void DescribePairing(const FrameMatcher& matcher, LiveReport& report);

}  // namespace stereomotion
