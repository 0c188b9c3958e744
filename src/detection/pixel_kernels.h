#pragma once

#include <cstdint>
#include <type_traits>

namespace stereomotion {

/// An image is scanned in bands of four rows. A band is divided into chunks, which are searched for
/// bright pixels, and each chunk into four blocks, whose sums show light too weak for one pixel.
struct Band {
  static constexpr int kRows = 4;
  static constexpr int kChunk_px = 32;
  static constexpr int kBlock_px = 8;
  static constexpr int kBlocksPerChunk = kChunk_px / kBlock_px;
};

/// Sums of a block, and of the two by two blocks of a window (128 pixels), fit this type.
template <class T>
using BlockSum = std::conditional_t<sizeof(T) == 1, std::int16_t, std::int32_t>;

/// The loops over all pixels, in the version that this machine runs best. All versions give the
/// same results; `Portable` is what the others are tested against.
template <class T>
struct PixelKernels {
  /// Marks the chunks that hold a pixel above their threshold (1, else 0), and sums the blocks.
  /// Tells whether any chunk is marked. Reads `chunks` × 32 pixels of each of four rows.
  using Scan = bool (*)(const T* const* rows, int chunks, const T* thresholds, std::uint8_t* marks,
                        BlockSum<T>* sums);
  /// Gives a bit for each of 32 pixels, the first one the lowest: 1 where above the threshold.
  using Above = std::uint32_t (*)(const T* pixels, T threshold);

  /// Gives the mean of each of `count` stretches of 32 pixels, and their variance by the
  /// differences of neighbours, which uneven light does not enter (von Neumann 1941). The stretches
  /// begin `step_px` apart.
  using Measure = void (*)(const T* row, int count, int step_px, float* means, float* variances);

  Scan scan;
  Above above;
  Measure measure;

  static PixelKernels Portable();
  static PixelKernels Best();
};

}  // namespace stereomotion
