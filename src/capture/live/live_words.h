#pragma once

#include <array>
#include <string>
#include <vector>

#include "frame_matcher.h"
#include "stereomotion/capture/live_report.h"

namespace stereomotion {

/// Says why no image came, and what to do.
std::string NoImagesText(const std::string& uri, const DeviceCounts& counts, double waited_s);

/// Says that a lost camera did not come back.
std::string CameraLostText(const std::string& uri, const std::string& why, double waited_s);

/// Says what a person should know of how the images were put together.
std::vector<std::string> PairingWarnings(const FrameMatcher& matcher,
                                         const std::array<std::string, 2>& uris);

}  // namespace stereomotion
