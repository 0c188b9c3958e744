#include "segment_blobs.h"

#include <algorithm>
#include <cstddef>

#include "pixel_clamp.h"

namespace stereomotion {
namespace {

/// An image with more runs than one in so many pixels, and some, holds no scene of balls; its
/// threshold is raised so that it cannot take unbounded time.
constexpr std::size_t kPixelsPerRun = 64;
constexpr std::size_t kFewRuns = 1024;
constexpr int kRaisings = 2;
constexpr double kRaise = 4;
/// Smaller things, in pixels above half their height, are no balls (of 2 px diameter).
constexpr int kSmallestBall_px = 4;
/// Where there are more smaller ones than one in so many pixels (and some), blobs of less than 4 px
/// diameter are likely chance clusters of them: all are left out.
constexpr int kPixelsPerSpeck = 640;
constexpr int kFewSpecks = 256;
constexpr int kSmallestAmongSpecks_px = 12;
/// A glint on a ball is small, and most of what is above the threshold lies below half its height.
constexpr int kLargestGlint_px = 12;
constexpr double kTipShare = 0.4;

bool IsBefore(const Run& a, const Run& b) { return a.v != b.v ? a.v < b.v : a.u_begin < b.u_begin; }

}  // namespace

template <class T>
void Segmenter::MeasurePeaks() {
  for (const Run& run : above_.runs) {
    Peak& peak = peaks_[static_cast<std::size_t>(run.label)];
    const T* row = image_.Row<T>(run.v);
    const T* highest = std::max_element(row + run.u_begin, row + run.u_end);
    if (*highest <= peak.peak_dn) continue;
    peak.peak_dn = *highest;
    const auto cell =
        static_cast<std::size_t>(background_->CellAt(static_cast<int>(highest - row), run.v));
    peak.background_dn = background_->level_dn[cell];
    peak.noise_dn = background_->noise_dn[cell];
  }
}

/// Tells bright balls from what is left to the weak blobs, and from specks.
void Segmenter::SortPeaks(double threshold_sigma) {
  for (Peak& peak : peaks_) {
    // Lower ones would be cut at the threshold, not at half their height.
    peak.is_ball_like = peak.peak_dn - peak.background_dn > 2 * threshold_sigma * peak.noise_dn;
    const bool is_tip =
        peak.half_area_px <= kLargestGlint_px && peak.half_area_px < kTipShare * peak.area_px;
    peak.is_speck = peak.is_ball_like && (peak.half_area_px < kSmallestBall_px || is_tip);
  }
}

/// Leaves out the small components of an image that is full of specks.
void Segmenter::DropManySpecks() {
  peaks_.assign(static_cast<std::size_t>(above_.num_labels), Peak{});
  for (const Run& run : above_.runs) {
    peaks_[static_cast<std::size_t>(run.label)].area_px += run.u_end - run.u_begin;
  }
  const auto specks = std::count_if(peaks_.begin(), peaks_.end(), [](const Peak& peak) {
    return peak.area_px < kSmallestBall_px;
  });
  if (specks <= kFewSpecks + image_.width_px * image_.height_px / kPixelsPerSpeck) return;
  for (Peak& peak : peaks_) peak.is_ball_like = peak.area_px >= kSmallestAmongSpecks_px;
  DropRuns(above_);
}

/// Removes the runs of peaks that are none, or not any more.
void Segmenter::DropRuns(RunList& list) {
  const auto is_dropped = [&](const Run& run) {
    return !peaks_[static_cast<std::size_t>(run.label)].is_ball_like;
  };
  const auto end = std::remove_if(list.runs.begin(), list.runs.end(), is_dropped);
  if (end == list.runs.end()) return;
  list.runs.erase(end, list.runs.end());
  list.IndexRows();
}

void Segmenter::FindWeakBlobs(double threshold_sigma) {
  weak_.Start(image_, *background_, mask_, threshold_sigma);
  for (const Run& run : above_.runs) {
    const Peak& peak = peaks_[static_cast<std::size_t>(run.label)];
    if (!peak.is_ball_like || (peak.is_speck && peak.area_px > peak.half_area_px)) {
      weak_.Look(run);
    } else if (!peak.is_speck) {
      weak_.Cover(run);
    }
  }
  for (const WindowMark& mark : scan_.marks()) weak_.Look(mark);
  DropRuns(above_);
  weak_.Search(above_, peaks_);
  DropRuns(above_);
  DropRuns(half_);
}

/// Adds the weak blobs' runs to the bright ones'; their labels follow the bright ones'.
void Segmenter::MergeWeakRuns() {
  if (weak_.half_runs().empty()) return;
  const int first_label = above_.num_labels;
  const auto merge = [&](const std::vector<Run>& weak, RunList& list) {
    merged_.resize(list.runs.size() + weak.size());
    std::merge(list.runs.begin(), list.runs.end(), weak.begin(), weak.end(), merged_.begin(),
               IsBefore);
    list.runs.swap(merged_);
  };
  weak_.ShiftLabels(first_label);
  merge(weak_.runs().runs, above_);
  merge(weak_.half_runs(), half_);
  above_.num_labels += weak_.runs().num_labels;
  above_.IndexRows();
  peaks_.insert(peaks_.end(), weak_.peaks().begin(), weak_.peaks().end());
}

template <class T>
void Segmenter::CutAtHalfHeight() {
  half_.Start(image_.height_px);
  for (const Run& run : above_.runs) {
    Peak& peak = peaks_[static_cast<std::size_t>(run.label)];
    const T threshold = ClampToPixel<T>(0.5 * (peak.peak_dn + peak.background_dn));
    const T* row = image_.Row<T>(run.v);
    for (int u = run.u_begin; u < run.u_end;) {
      while (u < run.u_end && row[u] <= threshold) ++u;
      const int start = u;
      while (u < run.u_end && row[u] > threshold) ++u;
      if (u == start) continue;
      half_.Append(run.v, start, u, run.label);
      peak.half_area_px += u - start;
    }
  }
}

template <class T>
void Segmenter::SegmentAs(double threshold_sigma) {
  const double bright_sigma = FindRuns(threshold_sigma);
  DropManySpecks();
  MeasurePeaks<T>();
  CutAtHalfHeight<T>();
  SortPeaks(bright_sigma);
  // Weak balls close to the threshold have many runs themselves: theirs is not raised.
  FindWeakBlobs(threshold_sigma);
  MergeWeakRuns();
}

/// Finds the runs above the threshold; gives the threshold that was used.
double Segmenter::FindRuns(double threshold_sigma) {
  const std::size_t most_runs = kFewRuns + static_cast<std::size_t>(image_.width_px) *
                                               static_cast<std::size_t>(image_.height_px) /
                                               kPixelsPerRun;
  for (int i = 0; i <= kRaisings; ++i) {
    above_.Start(image_.height_px);
    if (scan_.Scan(image_, *background_, mask_, area_, threshold_sigma, most_runs, above_)) break;
    above_.Start(image_.height_px);
    threshold_sigma *= kRaise;
  }
  // Intervals side by side are searched one after the other.
  if (!area_.is_whole()) std::sort(above_.runs.begin(), above_.runs.end(), IsBefore);
  above_.Connect();
  return threshold_sigma;
}

void Segmenter::SegmentArea(const ImageView& image, const BackgroundMap& background,
                            double threshold_sigma, const ImageMask* mask) {
  image_ = image;
  background_ = &background;
  mask_ = mask != nullptr && !mask->empty() ? mask : nullptr;
  if (image.type == PixelType::kGray8) {
    SegmentAs<std::uint8_t>(threshold_sigma);
  } else {
    SegmentAs<std::uint16_t>(threshold_sigma);
  }
  GatherBlobs(peaks_, half_, parent_of_run_, blobs_);
}

void Segmenter::Segment(const ImageView& image, const BackgroundMap& background,
                        double threshold_sigma, const ImageMask* mask) {
  area_.SetWhole(image);
  SegmentArea(image, background, threshold_sigma, mask);
}

void Segmenter::Segment(const ImageView& image, const BackgroundMap& background,
                        double threshold_sigma, const ImageMask* mask,
                        const std::vector<SearchWindow>& windows) {
  area_.SetWindows(image, windows);
  SegmentArea(image, background, threshold_sigma, mask);
  const auto is_outside = [&](const Blob& blob) {
    return !area_.Surrounds(blob.u_min, blob.u_max, blob.v_min, blob.v_max) ||
           !IsInAnyWindow(blob.sum_u / blob.area_px, blob.sum_v / blob.area_px, windows);
  };
  blobs_.erase(std::remove_if(blobs_.begin(), blobs_.end(), is_outside), blobs_.end());
}

}  // namespace stereomotion
