#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "../pixel_formats.h"

namespace stereomotion::v4l2 {

/// Writes a V4L2 pixel format as its four letters without blanks at the end: "GREY", "Y10".
std::string FourccText(std::uint32_t fourcc);

/// Tells how the pixels of a V4L2 format are stored; `kUnknown`: it is not read by this program.
PixelFormat PixelFormatOf(std::uint32_t fourcc);

/// Finds the one of the `offered` formats that a user means: by its letters ("GREY", "y10"), or by
/// its GenICam name ("Mono8", "BayerRG8"), so that a rig.yaml serves both kinds of cameras. 0:
/// none.
std::uint32_t FindFourcc(const std::string& name, const std::vector<std::uint32_t>& offered);

/// Picks the best format for measuring: grey before what only contains grey, before colour filters,
/// before lossy compression; 8 bits before more, which cost bandwidth and so rate. 0: none is read.
std::uint32_t BestFourcc(const std::vector<std::uint32_t>& offered);

}  // namespace stereomotion::v4l2
