#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "frame_stream.h"

namespace stereomotion {

/// Reads timestamps.csv: a header with `frame` and `timestamp_ns`, optionally `exposure_us` and
/// `pair`; other columns are left alone. Times must ascend. Throws `UserError` with file and line.
std::vector<FrameInfo> ReadTimestamps(const std::filesystem::path& file);

/// The header line, with its end, of what `TimestampsRow` spells.
constexpr const char* kTimestampsHeader = "frame,timestamp_ns,exposure_us,pair\n";

/// Spells a frame as a row of timestamps.csv, with its end.
std::string TimestampsRow(const FrameInfo& frame);

}  // namespace stereomotion
