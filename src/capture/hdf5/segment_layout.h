#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "stereomotion/core/image.h"

namespace stereomotion {

/// Says what one camera's images are like, and how many fit into a segment.
struct SegmentCamera {
  std::string name;  ///< of the HDF5 group
  int width_px = 0, height_px = 0;
  PixelType type = PixelType::kGray8;
  std::int64_t capacity = 0;  ///< frames
  int grey_bits = 0;          ///< as in `ImageView`

  [[nodiscard]] std::int64_t row_bytes() const {
    return static_cast<std::int64_t>(width_px) * (type == PixelType::kGray8 ? 1 : 2);
  }
  [[nodiscard]] std::int64_t image_bytes() const { return row_bytes() * height_px; }
};

/// Names the columns of a segment beside its images; all have cells of eight bytes.
enum FrameColumn { kFrame, kTimestamp, kExposure, kDeviceTimestamp, kPair, kFrameColumns };
constexpr std::array<const char*, kFrameColumns> kColumnNames = {
    "frame", "timestamp_ns", "exposure_us", "device_timestamp_ns", "pair"};
constexpr std::int64_t kCellBytes = 8;

/// Number of a row that was not written.
constexpr std::int64_t kNoFrame = -1;

/// Tells where one camera's data lie in a segment's file [bytes].
struct SegmentOffsets {
  std::int64_t images = 0;
  std::array<std::int64_t, kFrameColumns> columns{};
  std::int64_t synced = 0;
};

/// Creates a segment through HDF5: a whole, valid file with room for all frames, every row of it
/// marked as not written. From then on its bytes are written in place, without HDF5. Throws
/// `OutputError`.
std::vector<SegmentOffsets> CreateSegment(const std::filesystem::path& file,
                                          const std::vector<SegmentCamera>& cameras);

}  // namespace stereomotion
