#include "stereomotion/core/image_mask.h"

#include <algorithm>
#include <stdexcept>

namespace stereomotion {

ImageMask::ImageMask(int width_px, int height_px) : width_px_(width_px), height_px_(height_px) {
  if (width_px <= 0 || height_px <= 0) throw std::invalid_argument("ImageMask: no pixels");
  masked_.assign(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px), 0);
}

void ImageMask::Mark(int v, int u_begin, int u_end) {
  if (v < 0 || v >= height_px_ || u_begin < 0 || u_end > width_px_) {
    throw std::invalid_argument("ImageMask: outside the image");
  }
  if (u_begin >= u_end) return;
  std::uint8_t* row = masked_.data() + static_cast<std::ptrdiff_t>(v) * width_px_;
  std::fill(row + u_begin, row + u_end, std::uint8_t{1});
}

std::int64_t ImageMask::CountMasked() const {
  return std::count(masked_.begin(), masked_.end(), std::uint8_t{1});
}

}  // namespace stereomotion
