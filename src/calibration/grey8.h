#pragma once

#include <opencv2/core.hpp>

#include "stereomotion/core/image.h"

namespace stereomotion {

/// Gives an image as 8 bits for a pattern search: as it is, or a 16-bit one scaled so that its
/// brightest pixel is white. Memory of 8-bit images is shared.
inline cv::Mat Grey8(const ImageView& image) {
  // OpenCV has no read-only matrix.
  auto* data = const_cast<std::uint8_t*>(image.data);
  const auto stride = static_cast<std::size_t>(image.stride_bytes);
  if (image.type == PixelType::kGray8) {
    return {image.height_px, image.width_px, CV_8UC1, data, stride};
  }
  const cv::Mat wide(image.height_px, image.width_px, CV_16UC1, data, stride);
  double top_dn = 0;
  cv::minMaxLoc(wide, nullptr, &top_dn);
  cv::Mat grey;
  wide.convertTo(grey, CV_8U, 255 / (top_dn > 0 ? top_dn : 1));
  return grey;
}

}  // namespace stereomotion
