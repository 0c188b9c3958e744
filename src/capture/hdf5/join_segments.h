#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "segment_layout.h"

namespace stereomotion {

/// Tells whether a file has the name of a segment: "000012.h5".
bool IsSegment(const std::filesystem::path& file);
/// Tells whether it has the name of one that was cut off while it was made: "000012.h5.part".
bool IsCutSegment(const std::filesystem::path& file);

/// Lists the segments of a recording in their order.
std::vector<std::filesystem::path> ListSegments(const std::filesystem::path& recording);

/// Tells what joining found.
struct JoinedSegments {
  std::vector<std::string> names;    ///< of the cameras
  std::vector<std::int64_t> frames;  ///< of each camera
  std::vector<std::string> notes;    ///< for a person: segments that cannot be read
};

/// Writes the file that joins all segments of a recording: numbers and times are copied, images
/// stay where they are (an HDF5 virtual dataset with names relative to the file). Segments without
/// a valid row are removed, room that no row uses is given back. Other files are left alone. Where
/// no segment can be read nothing is written. `trust_all`: else only rows count that were noted as
/// brought to the disk. Throws `OutputError`.
JoinedSegments JoinSegments(const std::filesystem::path& recording, bool trust_all);

}  // namespace stereomotion
