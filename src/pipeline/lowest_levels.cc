#include "lowest_levels.h"

#include <algorithm>
#include <limits>

namespace stereomotion {
namespace {

constexpr std::uint16_t kNothing = std::numeric_limits<std::uint16_t>::max();

template <class T>
void FillBrightest(const ImageView& image, Image& brightest) {
  const int w = image.width_px, h = image.height_px;
  std::vector<T> column(static_cast<std::size_t>(w) + 2);  // of three rows; 0 beside the image
  for (int v = 0; v < h; ++v) {
    const T* above = image.Row<T>(std::max(v - 1, 0));
    const T* here = image.Row<T>(v);
    const T* below = image.Row<T>(std::min(v + 1, h - 1));
    T* middle = column.data() + 1;
    for (int u = 0; u < w; ++u) middle[u] = std::max(std::max(above[u], here[u]), below[u]);
    T* out = brightest.Row<T>(v);
    for (int u = 0; u < w; ++u) {
      out[u] = std::max(std::max(middle[u - 1], middle[u]), middle[u + 1]);
    }
  }
}

std::uint16_t LevelAt(const ImageView& image, std::size_t pixel) {
  const auto width = static_cast<std::size_t>(image.width_px);
  const int u = static_cast<int>(pixel % width), v = static_cast<int>(pixel / width);
  return image.type == PixelType::kGray8 ? image.Row<std::uint8_t>(v)[u]
                                         : image.Row<std::uint16_t>(v)[u];
}

}  // namespace

Image BrightestNeighbours(const ImageView& image) {
  Image brightest;
  brightest.Resize(image.width_px, image.height_px, image.type);
  if (image.type == PixelType::kGray8) {
    FillBrightest<std::uint8_t>(image, brightest);
  } else {
    FillBrightest<std::uint16_t>(image, brightest);
  }
  return brightest;
}

void LowestLevels::Add(const ImageView& image) {
  const auto pixels =
      static_cast<std::size_t>(image.width_px) * static_cast<std::size_t>(image.height_px);
  if (images_ == 0) {
    width_px_ = image.width_px;
    height_px_ = image.height_px;
    type_ = image.type;
    lowest_.assign(pixels * static_cast<std::size_t>(count_), kNothing);
  }
  if (image.width_px != width_px_ || image.height_px != height_px_ || image.type != type_) return;
  ++images_;
  const auto count = static_cast<std::ptrdiff_t>(count_);
  for (std::size_t i = 0; i < pixels; ++i) {
    const std::uint16_t level = LevelAt(image, i);
    const auto first = lowest_.begin() + static_cast<std::ptrdiff_t>(i) * count;
    if (level >= *(first + count - 1)) continue;
    const auto place = std::upper_bound(first, first + count, level);
    std::move_backward(place, first + count - 1, first + count);
    *place = level;
  }
}

Image LowestLevels::Highest() const {
  Image image;
  image.Resize(width_px_, height_px_, type_);
  for (int v = 0; v < height_px_; ++v) {
    for (int u = 0; u < width_px_; ++u) {
      const auto pixel = static_cast<std::size_t>(v) * static_cast<std::size_t>(width_px_) +
                         static_cast<std::size_t>(u);
      const std::uint16_t level = lowest_[(pixel + 1) * static_cast<std::size_t>(count_) - 1];
      if (type_ == PixelType::kGray8) {
        image.Row<std::uint8_t>(v)[u] = static_cast<std::uint8_t>(level);
      } else {
        image.Row<std::uint16_t>(v)[u] = level;
      }
    }
  }
  return image;
}

}  // namespace stereomotion
