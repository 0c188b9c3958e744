#pragma once

#include <cstdint>
#include <vector>

#include "stereomotion/core/image.h"

namespace stereomotion {

/// Makes of each pixel the brightest of its 3×3 neighbourhood, so that what trembles by a pixel
/// stays.
Image BrightestNeighbours(const ImageView& image);

/// Keeps the lowest grey values that each pixel showed: the brightness that it never, or in a few
/// images only, falls below. What moves vanishes from it.
class LowestLevels {
 public:
  /// `count`: how many values a pixel are kept, so in `count` − 1 images it may be darker.
  explicit LowestLevels(int count) : count_(count) {}

  /// Adds an image. One of another size than the first is left out.
  void Add(const ImageView& image);

  [[nodiscard]] int images() const { return images_; }
  /// Makes the image of each pixel's highest kept value.
  [[nodiscard]] Image Highest() const;

 private:
  int count_;
  int images_ = 0;
  int width_px_ = 0, height_px_ = 0;
  PixelType type_ = PixelType::kGray8;
  std::vector<std::uint16_t> lowest_;  ///< `count_` a pixel, ascending
};

}  // namespace stereomotion
