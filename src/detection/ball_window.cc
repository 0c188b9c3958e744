#include "ball_window.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "blob_outline.h"

namespace stereomotion {
namespace {

/// A blob above threshold has its tail below it; a half-height cut lies deeper inside.
constexpr int kThresholdTail_px = 1;
constexpr int kHalfHeightTail_px = 3;
/// A part of the same bright region that is smaller than this share of the blob is no neighbour:
/// noise cut it off where the blob's limb is at half height.
constexpr double kSplinterShare = 0.1;

struct Interval {
  int begin, end;  ///< end: one past the last
};

bool IsSplinter(const std::vector<Blob>& blobs, int label, const Blob& of) {
  const auto found =
      std::lower_bound(blobs.begin(), blobs.end(), label,
                       [](const Blob& blob, int wanted) { return blob.label < wanted; });
  return found != blobs.end() && found->label == label && found->parent == of.parent &&
         found->area_px < kSplinterShare * of.area_px;
}

Interval InRow(const BlobOutline& outline, int v, int u_min, int u_max) {
  double first = 0;
  double last = 0;
  if (!outline.InRow(v, first, last)) return {u_min, u_min};
  first = std::max(first, static_cast<double>(u_min));
  last = std::min(last, static_cast<double>(u_max));
  // Image coordinates are not negative, so cutting off rounds down; std::floor would be a call.
  const int before = static_cast<int>(first);
  const int begin = before < first ? before + 1 : before;
  const int end = last >= 0 ? static_cast<int>(last) + 1 : begin;
  return {begin, std::max(begin, end)};
}

}  // namespace

void BallWindow::StartMasking() {
  if (any_masked_) return;
  const int pixels = (u_max_ - u_min_ + 1) * (v_max_ - v_min_ + 1);
  masked_.assign(static_cast<std::size_t>(pixels), 0);
  any_masked_ = true;
}

template <class IsOwn>
void BallWindow::MaskRuns(const RunList& list, int margin_px, const IsOwn& is_own) {
  const int width = u_max_ - u_min_ + 1;
  const int rows = static_cast<int>(list.row_begin.size()) - 1;
  const int first = list.row_begin[static_cast<std::size_t>(std::max(v_min_ - margin_px, 0))];
  const int last = list.row_begin[static_cast<std::size_t>(std::min(v_max_ + margin_px + 1, rows))];
  for (int i = first; i < last; ++i) {
    const Run& run = list.runs[static_cast<std::size_t>(i)];
    const int u_begin = std::max(run.u_begin - margin_px, u_min_) - u_min_;
    const int u_end = std::min(run.u_end + margin_px, u_max_ + 1) - u_min_;
    if (u_begin >= u_end || is_own(run.label)) continue;
    const int v_begin = std::max(run.v - margin_px, v_min_) - v_min_;
    const int v_end = std::min(run.v + margin_px, v_max_) - v_min_;
    StartMasking();
    for (int v = v_begin; v <= v_end; ++v) {
      std::fill(masked_.begin() + v * width + u_begin, masked_.begin() + v * width + u_end, 1);
    }
  }
}

void BallWindow::MaskBlobs(const Segmenter& segments, const Blob& blob) {
  any_masked_ = false;
  MaskRuns(segments.above_threshold(), kThresholdTail_px,
           [&](int label) { return label == blob.parent; });
  MaskRuns(segments.half_height(), kHalfHeightTail_px, [&](int label) {
    return label == blob.label || IsSplinter(segments.blobs(), label, blob);
  });
  if (segments.mask() != nullptr && !segments.mask()->empty()) MaskPixels(*segments.mask());
}

void BallWindow::MaskPixels(const ImageMask& mask) {
  StartMasking();
  const int width = u_max_ - u_min_ + 1;
  for (int v = v_min_; v <= v_max_; ++v) {
    const std::uint8_t* row = mask.Row(v) + u_min_;
    unsigned char* marks = masked_.data() + (v - v_min_) * width;
    for (int u = 0; u < width; ++u) marks[u] |= row[u];
  }
}

template <class T>
void BallWindow::TakePixels(const T* pixels, int v, int u_begin, int u_end,
                            BallPatch& patch) const {
  int n = patch.size;
  for (int u = u_begin; u < u_end; ++u) {
    if (IsMasked(u, v)) continue;
    patch.u[n] = static_cast<float>(u - origin_u_);
    patch.v[n] = static_cast<float>(v - origin_v_);
    patch.grey[n] = static_cast<float>(pixels[u]);
    ++n;
  }
  patch.size = n;
}

template <class T>
bool BallWindow::TakeRing(const T* pixels, int v, int u_begin, int u_end, double saturation_dn,
                          BackgroundSums& ring) const {
  std::int64_t n = 0, sum_u = 0, sum_uu = 0, grey = 0, u_grey = 0, grey2 = 0;
  for (int u = u_begin; u < u_end; ++u) {
    if (IsMasked(u, v)) continue;
    const std::int64_t value = pixels[u];
    if (value == 0 || static_cast<double>(value) >= saturation_dn) return false;
    const std::int64_t x = u - origin_u_;
    ++n;
    sum_u += x;
    sum_uu += x * x;
    grey += value;
    u_grey += x * value;
    grey2 += value * value;
  }
  const double y = v - origin_v_;
  ring.n += static_cast<double>(n);
  ring.u += static_cast<double>(sum_u);
  ring.v += y * static_cast<double>(n);
  ring.uu += static_cast<double>(sum_uu);
  ring.uv += y * static_cast<double>(sum_u);
  ring.vv += y * y * static_cast<double>(n);
  ring.grey += static_cast<double>(grey);
  ring.u_grey += static_cast<double>(u_grey);
  ring.v_grey += y * static_cast<double>(grey);
  ring.grey2 += static_cast<double>(grey2);
  return true;
}

template <class T>
bool BallWindow::CutRows(const ImageView& image, const Blob& blob, const SensorNoise& noise,
                         const Margins& margins, BallPatch& patch) {
  const BlobOutline core(blob, margins.tail_px);
  const BlobOutline whole(blob, margins.tail_px + margins.ring_px);
  patch.size = 0;
  patch.ring = {};
  for (int v = v_min_; v <= v_max_; ++v) {
    const T* pixels = image.Row<T>(v);
    const Interval outer = InRow(whole, v, u_min_, u_max_);
    Interval inner = InRow(core, v, u_min_, u_max_);
    if (inner.begin == inner.end) inner = {outer.begin, outer.begin};
    const double top = noise.saturation_dn;
    if (!TakeRing(pixels, v, outer.begin, inner.begin, top, patch.ring) ||
        !TakeRing(pixels, v, inner.end, outer.end, top, patch.ring)) {
      return false;
    }
    TakePixels(pixels, v, inner.begin, inner.end, patch);
  }
  return true;
}

void BallWindow::Cut(const ImageView& image, const Segmenter& segments, const Blob& blob,
                     const SensorNoise& noise, const Margins& margins, BallPatch& patch) {
  const double reach_px = margins.tail_px + margins.ring_px;
  half_px_ = BlobOutline(blob, 0).reach_px();
  const Eigen::Vector2d whole_px = half_px_.array() + reach_px;
  const Eigen::Vector2d middle_px(0.5 * (blob.u_min + blob.u_max), 0.5 * (blob.v_min + blob.v_max));
  const Eigen::Vector2i low = (middle_px - whole_px).array().floor().cast<int>();
  const Eigen::Vector2i high = (middle_px + whole_px).array().ceil().cast<int>();
  u_min_ = std::max(low.x(), 0);
  v_min_ = std::max(low.y(), 0);
  u_max_ = std::min(high.x(), image.width_px - 1);
  v_max_ = std::min(high.y(), image.height_px - 1);
  origin_u_ = (u_min_ + u_max_) / 2;
  origin_v_ = (v_min_ + v_max_) / 2;
  MaskBlobs(segments, blob);
  patch.Resize((u_max_ - u_min_ + 1) * (v_max_ - v_min_ + 1));
  const auto cut = [&](const Margins& widths) {
    return image.type == PixelType::kGray8
               ? CutRows<std::uint8_t>(image, blob, noise, widths, patch)
               : CutRows<std::uint16_t>(image, blob, noise, widths, patch);
  };
  if (!cut(margins)) cut({reach_px, 0});
}

}  // namespace stereomotion
