#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "stereomotion/core/image.h"
#include "stereomotion/detection/detect_balls.h"

namespace stereomotion {

/// Says which chunks (pixel_kernels.h) of an image are searched. Keeps its memory.
class SearchArea {
 public:
  /// Chunks [begin, end) of one band.
  struct Interval {
    int band = 0, begin = 0, end = 0;
  };

  void SetWhole(const ImageView& image);
  /// Covers the windows and the surroundings that matter to a ball inside: whatever its patch holds
  /// must be told from it.
  void SetWindows(const ImageView& image, const std::vector<SearchWindow>& windows);

  [[nodiscard]] bool is_whole() const { return is_whole_; }
  [[nodiscard]] int bands() const { return bands_; }
  /// Ordered by band, then chunk.
  [[nodiscard]] const std::vector<Interval>& intervals() const { return intervals_; }
  /// Tells whether the box (inclusive) and the pixels next to it were searched, where they are in
  /// the image at all.
  [[nodiscard]] bool Surrounds(int u_min, int u_max, int v_min, int v_max) const;

 private:
  void Reset(const ImageView& image);

  bool is_whole_ = true;
  int width_px_ = 0, height_px_ = 0;
  int bands_ = 0, chunks_ = 0;
  std::vector<std::uint8_t> searched_;  ///< bands × chunks, of windows only
  std::vector<Interval> intervals_;
};

/// Tells whether a point lies in one of the windows.
bool IsInAnyWindow(double u, double v, const std::vector<SearchWindow>& windows);

}  // namespace stereomotion
