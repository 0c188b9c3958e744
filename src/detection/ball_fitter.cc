#include "ball_fitter.h"

#include <algorithm>
#include <cmath>

#include "normal_distribution.h"

namespace stereomotion {
namespace {

/// Background kept around the blob's half-height box: the blur's tail (3 σ of a sharp lens) and a
/// border wide enough that its level and slopes cost the centre less than 2 % of its precision.
constexpr int kMargin_px = 6;
/// A blob above threshold has its tail below it; a half-height cut lies deeper inside.
constexpr int kThresholdTail_px = 1;
constexpr int kHalfHeightTail_px = 3;

BallModel InitialModel(const Blob& blob, const Eigen::Vector2d& origin_px) {
  using P = BallModel;
  BallModel model;
  model.values[P::kU] = blob.sum_u / blob.area_px - origin_px.x();
  model.values[P::kV] = blob.sum_v / blob.area_px - origin_px.y();
  model.values[P::kRadius] = std::max(std::sqrt(blob.area_px / kPi), 0.8);
  model.values[P::kBlur] = 0.8;
  model.values[P::kAmplitude] = 0.95 * (blob.peak_dn - blob.background_dn);
  model.values[P::kShading] = 0.1;
  model.values[P::kLevel] = blob.background_dn;
  return model;
}

}  // namespace

void BallFitter::MaskRuns(const RunList& list, int own_label, int margin_px) {
  const int width = u_max_ - u_min_ + 1;
  const int rows = static_cast<int>(list.row_begin.size()) - 1;
  const int first = list.row_begin[static_cast<std::size_t>(std::max(v_min_ - margin_px, 0))];
  const int last = list.row_begin[static_cast<std::size_t>(std::min(v_max_ + margin_px + 1, rows))];
  for (int i = first; i < last; ++i) {
    const Run& run = list.runs[static_cast<std::size_t>(i)];
    if (run.label == own_label) continue;
    const int u_begin = std::max(run.u_begin - margin_px, u_min_) - u_min_;
    const int u_end = std::min(run.u_end + margin_px, u_max_ + 1) - u_min_;
    if (u_begin >= u_end) continue;
    const int v_begin = std::max(run.v - margin_px, v_min_) - v_min_;
    const int v_end = std::min(run.v + margin_px, v_max_) - v_min_;
    for (int v = v_begin; v <= v_end; ++v) {
      std::fill(masked_.begin() + v * width + u_begin, masked_.begin() + v * width + u_end, 1);
    }
  }
}

void BallFitter::CutPatch(const ImageView& image, const Segmenter& segments, const Blob& blob) {
  u_min_ = std::max(blob.u_min - kMargin_px, 0);
  v_min_ = std::max(blob.v_min - kMargin_px, 0);
  u_max_ = std::min(blob.u_max + kMargin_px, image.width_px - 1);
  v_max_ = std::min(blob.v_max + kMargin_px, image.height_px - 1);
  origin_px_ = {(u_min_ + u_max_) / 2, (v_min_ + v_max_) / 2};
  const int width = u_max_ - u_min_ + 1;
  const int capacity = width * (v_max_ - v_min_ + 1);
  masked_.assign(static_cast<std::size_t>(capacity), 0);
  MaskRuns(segments.above_threshold(), blob.parent, kThresholdTail_px);
  MaskRuns(segments.half_height(), blob.label, kHalfHeightTail_px);
  patch_.Resize(capacity);
  // The window is the ellipse around the blob; its corners would tell little and cost a fifth.
  const double mid_u = 0.5 * (blob.u_min + blob.u_max);
  const double mid_v = 0.5 * (blob.v_min + blob.v_max);
  const double reach_u = 0.5 * (blob.u_max - blob.u_min + 1) + kMargin_px;
  const double reach_v = 0.5 * (blob.v_max - blob.v_min + 1) + kMargin_px;
  int n = 0;
  for (int v = v_min_; v <= v_max_; ++v) {
    const double y = (v - mid_v) / reach_v;
    const double half_width = reach_u * std::sqrt(std::max(1 - y * y, 0.0));
    const int u_begin = std::max(u_min_, static_cast<int>(std::ceil(mid_u - half_width)));
    const int u_end = std::min(u_max_, static_cast<int>(std::floor(mid_u + half_width)));
    for (int u = u_begin; u <= u_end; ++u) {
      if (masked_[static_cast<std::size_t>((v - v_min_) * width + u - u_min_)] != 0) continue;
      patch_.u[n] = static_cast<float>(u - origin_px_.x());
      patch_.v[n] = static_cast<float>(v - origin_px_.y());
      patch_.grey[n] = static_cast<float>(image.At(u, v));
      ++n;
    }
  }
  patch_.size = n;
}

const BallFit& BallFitter::Fit(const ImageView& image, const Segmenter& segments, const Blob& blob,
                               const SensorNoise& noise) {
  CutPatch(image, segments, blob);
  fit_ = FitBall(noise, InitialModel(blob, origin_px_), patch_);
  return fit_;
}

}  // namespace stereomotion
