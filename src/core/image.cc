#include "stereomotion/core/image.h"

namespace stereomotion {

void Image::Resize(int width_px, int height_px, PixelType type) {
  const int bytes_per_pixel = type == PixelType::kGray8 ? 1 : 2;
  constexpr std::ptrdiff_t kRowAlignment = 64;
  width_px_ = width_px;
  height_px_ = height_px;
  type_ = type;
  grey_bits_ = 0;
  stride_bytes_ = (static_cast<std::ptrdiff_t>(width_px) * bytes_per_pixel + kRowAlignment - 1) /
                  kRowAlignment * kRowAlignment;
  bytes_.resize(static_cast<std::size_t>(stride_bytes_ * height_px));
}

ImageView Image::View() const {
  return {bytes_.data(), width_px_, height_px_, stride_bytes_, type_, grey_bits_};
}

}  // namespace stereomotion
