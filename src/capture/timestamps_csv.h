#pragma once

#include <filesystem>
#include <vector>

#include "frame_stream.h"

namespace stereomotion {

/// Reads timestamps.csv: a header with `frame` and `timestamp_ns`, optionally `exposure_us`; other
/// columns are left alone. Times must ascend. Throws `UserError` with file and line.
std::vector<FrameInfo> ReadTimestamps(const std::filesystem::path& file);

}  // namespace stereomotion
