#include "weak_blobs.h"

#include <algorithm>
#include <cstddef>

namespace stereomotion {
namespace {

/// Around a bright blob's run: its blurred limb.
constexpr int kCover_px = 3;
/// Detection threshold in the smoothed image, in units of its own noise, against a single pixel's
/// in the image (5 sigma where that is 6): noise passes it once in 3·10⁶ pixels, and only places
/// that are marked are looked at.
constexpr double kSmoothedShare = 5.0 / 6.0;
/// A box of 3×3 pixels leaves a third of their noise.
constexpr double kSmoothedNoise = 1.0 / 3.0;
/// Single pixels count up to so many thresholds: a lone bright one does not even come to half the
/// smoothed threshold.
constexpr double kClip = 1;
/// Weak balls have pixels up to so many thresholds high; more is a glint's.
constexpr double kHighest = 2;
/// Pixels above this share of the highest one tell a blob's height: the highest one itself would be
/// the one that noise raised most.
constexpr float kPlateau = 0.75F;
/// Two or three bright pixels side by side fill up to 16 smoothed ones; a ball of 5 px 20.
constexpr int kSmallestArea_px = 17;

}  // namespace

void WeakBlobs::Start(const ImageView& image, const BackgroundMap& background,
                      const ImageMask* mask, double sigma) {
  image_ = image;
  background_ = &background;
  sigma_ = sigma;
  bands_ = (image.height_px + Band::kRows - 1) / Band::kRows;
  blocks_ = (image.width_px + Band::kBlock_px - 1) / Band::kBlock_px;
  any_look_ = false;
  covered_.assign(static_cast<std::size_t>(bands_) * static_cast<std::size_t>(blocks_), 0);
  scan_.Start(image, background, mask, kClip * sigma);
  peaks_.clear();
  half_.Start(image.height_px);
}

void WeakBlobs::Cover(const Run& run) {
  const int band_end = std::min((run.v + kCover_px) / Band::kRows + 1, bands_);
  const int block_begin = std::max(run.u_begin - kCover_px, 0) / Band::kBlock_px;
  const int block_end = std::min((run.u_end - 1 + kCover_px) / Band::kBlock_px + 1, blocks_);
  for (int band = std::max(run.v - kCover_px, 0) / Band::kRows; band < band_end; ++band) {
    const auto row = covered_.begin() + static_cast<std::ptrdiff_t>(band) * blocks_;
    std::fill(row + block_begin, row + block_end, 1);
  }
}

void WeakBlobs::Look(const Run& run) {
  any_look_ = true;
  const int band = run.v / Band::kRows;
  scan_.Choose(band - 2, band + 3, run.u_begin / Band::kBlock_px - 1,
               (run.u_end - 1) / Band::kBlock_px + 2);
}

void WeakBlobs::Look(const WindowMark& mark) {
  const std::uint8_t* above = covered_.data() + (mark.band - 1) * blocks_ + mark.block;
  const std::uint8_t* below = above + blocks_;
  if ((above[0] | above[1] | below[0] | below[1]) != 0) return;
  any_look_ = true;
  scan_.Choose(mark.band - 2, mark.band + 2, mark.block - 1, mark.block + 3);
}

void WeakBlobs::MeasurePeaks() {
  const RunList& runs = scan_.runs();
  const auto labels = static_cast<std::size_t>(runs.num_labels);
  peaks_.assign(labels, Peak{});
  const float* rise = scan_.rises_dn().data();
  for (const Run& run : runs.runs) {
    Peak& peak = peaks_[static_cast<std::size_t>(run.label)];
    const int length = run.u_end - run.u_begin;
    const float* highest = std::max_element(rise, rise + length);
    if (*highest > peak.peak_dn) {
      const int u = run.u_begin + static_cast<int>(highest - rise);
      peak.peak_dn = *highest;
      peak.background_dn = background_->LevelAt(static_cast<float>(u), static_cast<float>(run.v));
      peak.noise_dn =
          background_->noise_dn[static_cast<std::size_t>(background_->CellAt(u, run.v))];
    }
    rise += length;
  }
  for (Peak& peak : peaks_) {
    peak.is_weak = true;
    peak.is_ball_like = peak.peak_dn > kSmoothedShare * kSmoothedNoise * sigma_ * peak.noise_dn;
  }
}

/// Makes means of the highest pixels of the peaks: smoothed ones, which tell where to cut, and
/// those of the image, which were not clipped.
void WeakBlobs::AveragePlateaus() {
  plateaus_.assign(peaks_.size(), Plateau{});
  const float* rise = scan_.rises_dn().data();
  for (const Run& run : scan_.runs().runs) {
    const Peak& peak = peaks_[static_cast<std::size_t>(run.label)];
    Plateau& plateau = plateaus_[static_cast<std::size_t>(run.label)];
    const int length = run.u_end - run.u_begin;
    const auto lowest = kPlateau * static_cast<float>(peak.peak_dn);
    const auto highest_dn =
        static_cast<float>(peak.background_dn + kHighest * sigma_ * peak.noise_dn);
    for (int i = 0; peak.is_ball_like && i < length; ++i) {
      if (rise[i] < lowest) continue;
      plateau.rise_dn += rise[i];
      plateau.pixels_dn += std::min<float>(image_.At(run.u_begin + i, run.v), highest_dn);
      ++plateau.count;
    }
    rise += length;
  }
  for (std::size_t i = 0; i < peaks_.size(); ++i) {
    if (!peaks_[i].is_ball_like) continue;
    plateaus_[i].rise_dn /= static_cast<float>(plateaus_[i].count);
    peaks_[i].peak_dn = plateaus_[i].pixels_dn / static_cast<float>(plateaus_[i].count);
  }
}

template <class Action>
void WeakBlobs::ForEachContact(const RunList& bright, const Action& action) const {
  for (const Run& run : scan_.runs().runs) {
    const auto row = static_cast<std::size_t>(run.v);
    for (int i = bright.row_begin[row]; i < bright.row_begin[row + 1]; ++i) {
      const Run& other = bright.runs[static_cast<std::size_t>(i)];
      if (other.u_begin > run.u_end || run.u_begin > other.u_end) continue;
      action(static_cast<std::size_t>(run.label), static_cast<std::size_t>(other.label));
    }
  }
}

void WeakBlobs::Reject(const RunList& bright, const std::vector<Peak>& bright_peaks) {
  ForEachContact(bright, [&](std::size_t weak, std::size_t other) {
    if (!bright_peaks[other].is_speck) peaks_[weak].is_ball_like = false;
  });
}

/// Also rejects what is too small.
void WeakBlobs::CutAtHalfHeight() {
  const float* rise = scan_.rises_dn().data();
  for (const Run& run : scan_.runs().runs) {
    Peak& peak = peaks_[static_cast<std::size_t>(run.label)];
    const float half = 0.5F * plateaus_[static_cast<std::size_t>(run.label)].rise_dn;
    for (int u = run.u_begin; u < run.u_end; ++u, ++rise) {
      if (!peak.is_ball_like || *rise <= half) continue;
      half_.Append(run.v, u, u + 1, run.label);
      ++peak.half_area_px;
    }
  }
  for (Peak& peak : peaks_) peak.is_ball_like &= peak.half_area_px >= kSmallestArea_px;
  const auto is_none = [&](const Run& run) {
    return !peaks_[static_cast<std::size_t>(run.label)].is_ball_like;
  };
  for (std::vector<Run>* runs : {&half_.runs, &scan_.runs().runs}) {
    runs->erase(std::remove_if(runs->begin(), runs->end(), is_none), runs->end());
  }
}

void WeakBlobs::Search(const RunList& bright, std::vector<Peak>& bright_peaks) {
  if (!any_look_) return;
  // Half the detection threshold, so that the weakest blob is known down to half its height.
  scan_.FindRuns(0.5 * kSmoothedShare * kSmoothedNoise * sigma_);
  MeasurePeaks();
  Reject(bright, bright_peaks);
  AveragePlateaus();
  CutAtHalfHeight();
  ForEachContact(bright, [&](std::size_t weak, std::size_t other) {
    if (peaks_[weak].is_ball_like) bright_peaks[other].is_ball_like = false;
  });
}

void WeakBlobs::ShiftLabels(int first) {
  for (RunList* list : {&scan_.runs(), &half_}) {
    for (Run& run : list->runs) run.label += first;
  }
}

}  // namespace stereomotion
