#pragma once

#include <Eigen/Core>

#include "stereomotion/core/image.h"

namespace stereomotion {

/// Tells whether something that reaches so far around its centre, along u and v, leaves the image.
inline bool TouchesBorder(const ImageView& image, const Eigen::Vector2d& center_px,
                          const Eigen::Array2d& reach_px) {
  const Eigen::Array2d last(image.width_px - 1, image.height_px - 1);
  return (center_px.array() < reach_px).any() || (center_px.array() > last - reach_px).any();
}

}  // namespace stereomotion
