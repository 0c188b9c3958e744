#include "box_sums.h"

#include <algorithm>
#include <cstddef>
#include <type_traits>

#include "multiversion.h"

namespace stereomotion {
namespace {

constexpr std::size_t kWidth = Band::kChunk_px;

/// Adds up boxes of 3×3 clipped pixels; the rows begin one pixel before the first box's middle.
/// Marks the sums above `lowest`; tells whether there is any.
template <class T>
STEREOMOTION_INLINE bool AddBoxesAs(const T* __restrict above, const T* __restrict row,
                                    const T* __restrict below, T clip,
                                    const std::uint32_t* __restrict lowest, BoxSums& sums,
                                    BoxMarks& marks) {
  using Column = std::conditional_t<sizeof(T) == 1, std::uint16_t, std::uint32_t>;
  std::array<Column, kWidth + 2> columns;
  for (std::size_t i = 0; i < kWidth + 2; ++i) {
    columns[i] = static_cast<Column>(Column{std::min(above[i], clip)} + std::min(row[i], clip) +
                                     std::min(below[i], clip));
  }
  std::uint32_t any = 0;
  for (std::size_t i = 0; i < kWidth; ++i) {
    sums[i] = static_cast<Column>(columns[i] + columns[i + 1] + columns[i + 2]);
    any |= sums[i] > lowest[i] ? 1 : 0;
  }
  if (any == 0) return false;
  for (std::size_t i = 0; i < kWidth; ++i) marks[i] = sums[i] > lowest[i] ? 1 : 0;
  return true;
}

}  // namespace

STEREOMOTION_MULTIVERSION
bool AddBoxes(const std::uint8_t* above, const std::uint8_t* row, const std::uint8_t* below,
              std::uint8_t clip, const std::uint32_t* lowest, BoxSums& sums, BoxMarks& marks) {
  return AddBoxesAs(above, row, below, clip, lowest, sums, marks);
}

STEREOMOTION_MULTIVERSION
bool AddBoxes(const std::uint16_t* above, const std::uint16_t* row, const std::uint16_t* below,
              std::uint16_t clip, const std::uint32_t* lowest, BoxSums& sums, BoxMarks& marks) {
  return AddBoxesAs(above, row, below, clip, lowest, sums, marks);
}

}  // namespace stereomotion
