#pragma once

namespace stereomotion {

/// Variance of a place spread evenly over one pixel's width: what sampling by square pixels adds to
/// an image's blur.
constexpr double kPixelVariance_px2 = 1.0 / 12.0;

}  // namespace stereomotion
