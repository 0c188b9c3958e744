#pragma once

#include <array>

#include "wavelet_plane.h"

namespace stereomotion {

/// Holds the two components of one scale of the transform: the gradient [DN/px] of the smoothed
/// image. Entry (i, j) belongs to the place (i + ½, j + ½).
struct WaveletScale {
  WaveletPlane u, v;
};

constexpr int kWaveletScales = 3;

/// Holds a weight for each entry of each scale.
using WaveletWeights = std::array<WaveletScale, kWaveletScales>;

/// Sets the weights of the scales from `first_scale` on to zero.
void ClearWeights(int width, int height, int first_scale, WaveletWeights& weights);

/// Computes the dyadic wavelet transform with the quadratic spline of Mallat & Zhong (1992) by the
/// algorithme à trous, and its adjoint.
///
/// Scale k (1, 2, 3) is their 2^k. Smoothing by (1 3 3 1)/8, taps 2^(k−1) apart; differences over
/// 2^(k−1) px. Two things differ from the paper: every scale has unit response to a ramp, so that a
/// product of scales is a squared gradient; and across the difference the image is smoothed, by
/// (1 1)/2 at scale 1, which puts all scales on one grid, and by (1 4 1)/6 above, which smooths as
/// much as the difference does along: so the scales blur an edge of any direction alike. Entries
/// whose taps would leave the image mean nothing: they form a border of `Border(scale)` px.
class WaveletTransform {
 public:
  static constexpr int kScales = kWaveletScales;

  /// Counts the entries along each side that the taps of scale k cannot determine.
  [[nodiscard]] static constexpr int Border(int scale) { return scale == 1 ? 1 : 4 * scale - 5; }

  /// Transforms `image`; scales below `first_scale` are left as they were.
  void Forward(const WaveletPlane& image, int first_scale = 1);

  /// Computes the transposed linear map: from weights on the scales' entries to weights on pixels.
  /// Exact where the weights keep two entries more off the sides than `Border`. Scales below
  /// `first_scale` count as zero.
  void Adjoint(const WaveletWeights& weights, WaveletPlane& pixels, int first_scale = 1);

  [[nodiscard]] const WaveletScale& scale(int k) const {
    return scales_[static_cast<std::size_t>(k - 1)];
  }

 private:
  std::array<WaveletScale, kScales> scales_;
  WaveletPlane smooth_, smoother_, rows_;
};

}  // namespace stereomotion
