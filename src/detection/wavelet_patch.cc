#include "wavelet_patch.h"

#include <algorithm>

namespace stereomotion {
namespace {

/// A blob above threshold has its tail below it; a half-height cut lies deeper inside.
constexpr int kThresholdTail_px = 1;
constexpr int kHalfHeightTail_px = 2;

}  // namespace

void WaveletPatch::PaintOver(const RunList& list, int own_label, int margin_px, float level_dn) {
  const auto u_origin = static_cast<int>(origin_px.x());
  const auto v_origin = static_cast<int>(origin_px.y());
  const int rows = static_cast<int>(list.row_begin.size()) - 1;
  const int v_first = std::clamp(v_origin - margin_px, 0, rows);
  const int v_last = std::clamp(v_origin + grey_dn.height + margin_px, 0, rows);
  const int last = list.row_begin[static_cast<std::size_t>(v_last)];
  for (int i = list.row_begin[static_cast<std::size_t>(v_first)]; i < last; ++i) {
    const Run& run = list.runs[static_cast<std::size_t>(i)];
    const int u_begin = std::max(run.u_begin - margin_px - u_origin, 0);
    const int u_end = std::min(run.u_end + margin_px - u_origin, grey_dn.width);
    if (run.label == own_label || u_begin >= u_end) continue;
    const int v_begin = std::max(run.v - margin_px - v_origin, 0);
    const int v_end = std::min(run.v + margin_px - v_origin, grey_dn.height - 1);
    for (int v = v_begin; v <= v_end; ++v) {
      std::fill(grey_dn.Row(v) + u_begin, grey_dn.Row(v) + u_end, level_dn);
      std::fill(variance_dn2.Row(v) + u_begin, variance_dn2.Row(v) + u_end, 0.0F);
    }
  }
}

void WaveletPatch::Cut(const ImageView& image, const Segmenter& segments, const Blob& blob,
                       const SensorNoise& noise, int margin_px) {
  const int u_origin = blob.u_min - margin_px;
  const int v_origin = blob.v_min - margin_px;
  origin_px = {u_origin, v_origin};
  grey_dn.Resize(blob.u_max - blob.u_min + 1 + 2 * margin_px,
                 blob.v_max - blob.v_min + 1 + 2 * margin_px);
  variance_dn2.Resize(grey_dn.width, grey_dn.height);
  int saturated = 0;
  for (int j = 0; j < grey_dn.height; ++j) {
    const int v = std::clamp(v_origin + j, 0, image.height_px - 1);
    for (int i = 0; i < grey_dn.width; ++i) {
      const double grey = image.At(std::clamp(u_origin + i, 0, image.width_px - 1), v);
      const bool is_saturated = grey >= noise.saturation_dn;
      const bool is_censored = is_saturated || grey <= 0;
      grey_dn.Row(j)[i] = static_cast<float>(grey);
      variance_dn2.Row(j)[i] = is_censored ? 0.0F : static_cast<float>(noise.VarianceDn2(grey));
      if (is_saturated) ++saturated;
    }
  }
  saturated_share = static_cast<double>(saturated) / blob.area_px;
  const auto level_dn = static_cast<float>(blob.background_dn);
  PaintOver(segments.above_threshold(), blob.parent, kThresholdTail_px, level_dn);
  PaintOver(segments.half_height(), blob.label, kHalfHeightTail_px, level_dn);
}

}  // namespace stereomotion
