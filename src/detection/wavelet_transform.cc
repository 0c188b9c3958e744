#include "wavelet_transform.h"

#include "multiversion.h"

namespace stereomotion {
namespace {

/// Places the four taps 1 3 3 1 of one smoothing step: at shift + k spacing, k = 0 … 3.
struct Taps {
  int spacing;
  int shift;
};
constexpr Taps kFirst{1, -1};  // → the grid half a pixel on
constexpr Taps kFirstAdjoint{1, -2};
constexpr Taps kSecond{2, -3};  // symmetrical: stays on that grid, its own adjoint

STEREOMOTION_INLINE void Smooth(const float* __restrict in, std::ptrdiff_t spacing, int n,
                                float* __restrict out) {
  for (int i = 0; i < n; ++i) {
    out[i] =
        0.125F * (in[i] + in[i + 3 * spacing]) + 0.375F * (in[i + spacing] + in[i + 2 * spacing]);
  }
}

/// Smooths along rows, then along columns; what the taps do not reach is zero.
STEREOMOTION_MULTIVERSION
void SmoothBoth(const float* in, int width, int height, Taps taps, float* rows, float* out) {
  const int first = -taps.shift;
  const int last = 3 * taps.spacing + taps.shift;  // taps beyond the entry itself
  const std::ptrdiff_t w = width;
  const int inner = width - first - last;
  if (inner <= 0 || height <= first + last) {
    std::fill(out, out + w * height, 0.0F);
    return;
  }
  for (int v = 0; v < height; ++v) {
    float* row = rows + v * w;
    std::fill(row, row + first, 0.0F);
    Smooth(in + v * w, taps.spacing, inner, row + first);
    std::fill(row + first + inner, row + w, 0.0F);
  }
  std::fill(out, out + first * w, 0.0F);
  for (int v = first; v < height - last; ++v) {
    Smooth(rows + (v - first) * w, taps.spacing * w, width, out + v * w);
  }
  std::fill(out + (height - last) * w, out + height * w, 0.0F);
}

/// Adds scale × the difference over ± reach along rows or columns, (1 4 1)/6 of the lines ± reach
/// aside.
STEREOMOTION_MULTIVERSION
void AddDifference(const float* __restrict in, int width, int height, int reach, bool along_rows,
                   float scale, float* __restrict out) {
  const std::ptrdiff_t w = width;
  const std::ptrdiff_t ahead = along_rows ? reach : reach * w;
  const std::ptrdiff_t aside = along_rows ? reach * w : reach;
  const float middle = scale * (4.0F / 6.0F);
  const float side = scale * (1.0F / 6.0F);
  for (int v = reach; v < height - reach; ++v) {
    const float* __restrict from = in + v * w;
    float* __restrict to = out + v * w;
    for (int u = reach; u < width - reach; ++u) {
      const float* at = from + u;
      to[u] += middle * (at[ahead] - at[-ahead]) + side * (at[ahead + aside] - at[-ahead + aside] +
                                                           at[ahead - aside] - at[-ahead - aside]);
    }
  }
}

void SmoothPlane(const WaveletPlane& in, Taps taps, WaveletPlane& rows, WaveletPlane& out) {
  rows.Resize(in.width, in.height);
  out.Resize(in.width, in.height);
  SmoothBoth(in.values.data(), in.width, in.height, taps, rows.values.data(), out.values.data());
}

void AddPlaneDifference(const WaveletPlane& in, int reach, bool along_rows, float sign,
                        WaveletPlane& out) {
  AddDifference(in.values.data(), in.width, in.height, reach, along_rows,
                sign / static_cast<float>(2 * reach), out.values.data());
}

void Differentiate(const WaveletPlane& in, int reach, WaveletScale& out) {
  out.u.Resize(in.width, in.height);
  out.v.Resize(in.width, in.height);
  out.u.Fill(0);
  out.v.Fill(0);
  AddPlaneDifference(in, reach, true, 1, out.u);
  AddPlaneDifference(in, reach, false, 1, out.v);
}

/// Scale 1: the gradient of four pixels at the corner that they share.
void DifferentiateFinest(const WaveletPlane& in, WaveletScale& out) {
  out.u.Resize(in.width, in.height);
  out.v.Resize(in.width, in.height);
  out.u.Fill(0);
  out.v.Fill(0);
  for (int v = 0; v + 1 < in.height; ++v) {
    const float* upper = in.Row(v);
    const float* lower = in.Row(v + 1);
    for (int u = 0; u + 1 < in.width; ++u) {
      const float falling = lower[u + 1] - upper[u];  // the two diagonals
      const float rising = upper[u + 1] - lower[u];
      out.u.Row(v)[u] = 0.5F * (falling + rising);
      out.v.Row(v)[u] = 0.5F * (falling - rising);
    }
  }
}

void AddFinestAdjoint(const WaveletScale& in, WaveletPlane& out) {
  for (int v = 0; v + 1 < out.height; ++v) {
    float* upper = out.Row(v);
    float* lower = out.Row(v + 1);
    for (int u = 0; u + 1 < out.width; ++u) {
      const float falling = 0.5F * (in.u.At(u, v) + in.v.At(u, v));
      const float rising = 0.5F * (in.u.At(u, v) - in.v.At(u, v));
      lower[u + 1] += falling;
      upper[u] -= falling;
      upper[u + 1] += rising;
      lower[u] -= rising;
    }
  }
}

}  // namespace

void ClearWeights(int width, int height, int first_scale, WaveletWeights& weights) {
  for (std::size_t k = static_cast<std::size_t>(first_scale) - 1; k < weights.size(); ++k) {
    for (WaveletPlane* plane : {&weights[k].u, &weights[k].v}) {
      plane->Resize(width, height);
      plane->Fill(0);
    }
  }
}

void WaveletTransform::Forward(const WaveletPlane& image, int first_scale) {
  if (first_scale <= 1) DifferentiateFinest(image, scales_[0]);
  SmoothPlane(image, kFirst, rows_, smooth_);
  if (first_scale <= 2) Differentiate(smooth_, 1, scales_[1]);
  SmoothPlane(smooth_, kSecond, rows_, smoother_);
  Differentiate(smoother_, 2, scales_[2]);
}

void WaveletTransform::Adjoint(const WaveletWeights& weights, WaveletPlane& pixels,
                               int first_scale) {
  smoother_.Resize(weights[2].u.width, weights[2].u.height);
  smoother_.Fill(0);
  AddPlaneDifference(weights[2].u, 2, true, -1, smoother_);
  AddPlaneDifference(weights[2].v, 2, false, -1, smoother_);
  SmoothPlane(smoother_, kSecond, rows_, smooth_);
  if (first_scale <= 2) {
    AddPlaneDifference(weights[1].u, 1, true, -1, smooth_);
    AddPlaneDifference(weights[1].v, 1, false, -1, smooth_);
  }
  SmoothPlane(smooth_, kFirstAdjoint, rows_, pixels);
  if (first_scale <= 1) AddFinestAdjoint(weights[0], pixels);
}

}  // namespace stereomotion
