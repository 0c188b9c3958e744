#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "background_map.h"
#include "pixel_kernels.h"
#include "run_list.h"
#include "search_area.h"
#include "stereomotion/core/image.h"
#include "stereomotion/core/image_mask.h"
#include "window_sums.h"

namespace stereomotion {

/// Goes once over the pixels of an image and finds what rises over the background: single pixels,
/// and windows of 128 pixels whose mean does. Keeps its memory.
class PixelScan {
 public:
  /// Appends the runs of pixels that rise `sigma` over the background to `runs`, but for masked
  /// ones (`mask` may be null). Stops and tells false where they are more than `most_runs`.
  bool Scan(const ImageView& image, const BackgroundMap& background, const ImageMask* mask,
            const SearchArea& area, double sigma, std::size_t most_runs, RunList& runs);

  /// The windows that call for a closer look, in order.
  [[nodiscard]] const std::vector<WindowMark>& marks() const { return marks_; }

 private:
  template <class T>
  struct Buffers {
    PixelKernels<T> scanner = PixelKernels<T>::Best();
    WindowSums<T> windows;
    std::vector<T> thresholds;  ///< of the chunks of one row of cells
    std::vector<BlockSum<T>> sums;
  };

  template <class T>
  bool ScanAs(Buffers<T>& buffers, const SearchArea& area, double sigma, std::size_t most_runs);
  template <class T>
  void SetThresholds(int cell_row, double sigma, std::vector<T>& thresholds) const;
  template <class T>
  void ScanInterval(Buffers<T>& buffers, const SearchArea::Interval& interval);
  template <class T>
  void AppendChunk(const PixelKernels<T>& scanner, int v, int chunk, T threshold);
  void AppendBits(int v, int u_begin, std::uint32_t bits);

  ImageView image_;
  const BackgroundMap* background_ = nullptr;
  const ImageMask* mask_ = nullptr;
  RunList* runs_ = nullptr;
  Buffers<std::uint8_t> buffers8_;
  Buffers<std::uint16_t> buffers16_;
  std::vector<std::uint8_t> bright_;  ///< chunks of one interval
  std::vector<WindowMark> marks_;
};

}  // namespace stereomotion
