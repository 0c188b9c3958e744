#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "node.h"

namespace stereomotion::v4l2 {

/// Lists the pixel formats that a device offers, those too that this program does not read.
std::vector<std::uint32_t> OfferedFormats(const Node& node);
/// Writes formats for a person: "GREY, Y10".
std::string FormatNames(const std::vector<std::uint32_t>& formats);

/// Lists the sizes of images in a pixel format for a person: "640x480, 1280x960".
std::string OfferedSizes(const Node& node, std::uint32_t fourcc);

/// Lists the frame rates [Hz] at a format and size for a person: "15, 30, 60".
std::string OfferedRates(const Node& node, std::uint32_t fourcc, int width_px, int height_px);

}  // namespace stereomotion::v4l2
