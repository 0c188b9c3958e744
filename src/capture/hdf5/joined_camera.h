#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "segment_layout.h"

namespace stereomotion {

/// A run of valid rows of one segment.
struct SegmentRun {
  std::string file;  ///< name within the folder of segments
  std::int64_t first = 0, count = 0;
  std::int64_t capacity = 0;  ///< rows of that segment
};

/// Collects what all segments hold of one camera.
struct JoinedCamera {
  SegmentCamera shape;
  std::array<std::vector<std::int64_t>, kFrameColumns> columns;  ///< `kExposure` stays empty
  std::vector<double> exposure_us;
  std::vector<SegmentRun> runs;

  [[nodiscard]] std::int64_t frames() const {
    return static_cast<std::int64_t>(columns[kFrame].size());
  }
};

/// Writes `recording` (under another name first) of what was collected. Throws `OutputError`.
void WriteJoined(const std::filesystem::path& recording, const std::vector<JoinedCamera>& cameras);

}  // namespace stereomotion
