#pragma once

#include <array>
#include <cstdint>

#include "pixel_kernels.h"

namespace stereomotion {

/// Sums of boxes of 3×3 pixels, of one chunk; and a byte for each: 1 where the sum rises, else 0.
using BoxSums = std::array<std::uint32_t, Band::kChunk_px>;
using BoxMarks = std::array<std::uint8_t, Band::kChunk_px>;

/// Adds up boxes of 3×3 pixels, which count up to `clip`; the three rows begin one pixel before the
/// first box's middle, and end one behind the last's. Marks the sums above their `lowest`; tells
/// whether there is any (`marks` are not set where there is none).
bool AddBoxes(const std::uint8_t* above, const std::uint8_t* row, const std::uint8_t* below,
              std::uint8_t clip, const std::uint32_t* lowest, BoxSums& sums, BoxMarks& marks);
bool AddBoxes(const std::uint16_t* above, const std::uint16_t* row, const std::uint16_t* below,
              std::uint16_t clip, const std::uint32_t* lowest, BoxSums& sums, BoxMarks& marks);

}  // namespace stereomotion
