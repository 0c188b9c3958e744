#include "wavelet_classify.h"

#include <algorithm>
#include <cmath>

#include "chi2_limit.h"
#include "image_border.h"
#include "normal_distribution.h"
#include "pixel_variance.h"
#include "wavelet_radius.h"
#include "wavelet_surround.h"

namespace stereomotion {
namespace {

/// Less of the outline than this does not determine five numbers but by the model's small errors.
constexpr double kSmallestVisibleShare = 0.42;
/// Nor does a shorter arc: twice as wide as the reach of the coarse filter's sides, four σ each.
constexpr double kShortestArc_px = 18;
/// More of the outline than this is all of it but for single points.
constexpr double kWhole = 0.85;
/// Root mean square distance of the edge points beyond the noise's that the filters' grid explains.
/// A rod across the limb leaves 0.01 px and draws the centre by 0.03 px.
constexpr double kLargestMisfit_px = 0.006;
/// What noise alone does to one outline in 10^4 is rather a limb cut: with the few independent
/// points of a small ball, the option's tail would explain anything. (The bound on the normal tail
/// in `LargestChi2Dof` is wide by a factor of ten.)
constexpr double kLargestChi2Exponent = 3;
/// Two waves of the edge's steepness of this amplitude: it is 1.5 times as steep along the sides as
/// at the ends. Only a smear does that, of about a diameter for a ball of 6 px, half of one at 20
/// px; noise reaches half of this at 15 dB.
constexpr double kLargestSteepnessWave = 0.2;
/// Light just outside a whole outline, against the amplitude: there is more where the outline is
/// none. A smear of a diameter leaves a quarter.
constexpr double kLargestUnevenness = 0.12;
/// A sphere 44° off the axis has this outline; a flatter one is smeared or merged.
constexpr double kSmallestAxisRatio = 0.72;
/// A ball burnt out over more than half its area may be a lamp.
constexpr double kLargestSaturatedShare = 0.5;

/// Gathers the pixels inside an ellipse.
struct Inside {
  double bright_share = 1;  ///< of the pixels deeper inside than the limb's blur
  double mean_dn = 0;       ///< of the pixels within half the radius
};

Inside LookInside(const WaveletPatch& patch, const Outline& outline, double half_dn) {
  const Eigen::Matrix2d shape = outline.ellipse.Shape();
  const double radius_px = outline.ellipse.radius();
  const double deep = std::max(radius_px - std::max(outline.blur_px, 0.5), 0.5);
  const double core = std::max(0.5 * radius_px, 0.75);
  int deep_count = 0, bright_count = 0, core_count = 0;
  Inside inside;
  for (int v = 0; v < patch.grey_dn.height; ++v) {
    for (int u = 0; u < patch.grey_dn.width; ++u) {
      const Eigen::Vector2d x = Eigen::Vector2d(u, v) - outline.ellipse.center();
      const double rho2 = x.dot(shape * x);
      if (rho2 > deep * deep) continue;
      ++deep_count;
      if (patch.grey_dn.At(u, v) > half_dn) ++bright_count;
      if (rho2 > core * core) continue;
      ++core_count;
      inside.mean_dn += patch.grey_dn.At(u, v);
    }
  }
  if (deep_count > 0) inside.bright_share = static_cast<double>(bright_count) / deep_count;
  if (core_count > 0) inside.mean_dn /= core_count;
  return inside;
}

void CopyOutline(const Outline& outline, const Eigen::Vector2d& origin_px, BallObservation& ball) {
  const auto& p = outline.ellipse.values;
  const double stretch = outline.ellipse.stretch();
  const double radius_px = UnbiasedRadius(outline.ellipse.radius(), outline.blur_px);
  ball.center_px = origin_px + outline.ellipse.center();
  ball.covariance_px2 = outline.center_covariance_px2;
  ball.semi_major_px = radius_px / std::sqrt(1 - 2 * stretch);
  ball.semi_minor_px = radius_px / std::sqrt(1 + 2 * stretch);
  ball.angle_rad = 0.5 * std::atan2(p[Ellipse::kStretch2], p[Ellipse::kStretch1]);
  ball.blur_px = std::sqrt(std::max(outline.blur_px * outline.blur_px - kPixelVariance_px2, 0.0));
  ball.chi2_dof = outline.chi2_dof;
}

bool TouchesBorder(const ImageView& image, const BallObservation& ball) {
  // One pixel more than the outline: the blurred limb must lie inside as well.
  return TouchesBorder(image, ball.center_px, Eigen::Array2d::Constant(ball.semi_major_px + 1));
}

bool IsArcTooShort(const Outline& outline) {
  const double arc_px = 2 * kPi * outline.ellipse.radius() * outline.visible_share;
  return outline.visible_share < kSmallestVisibleShare ||
         (outline.visible_share < kWhole && arc_px < kShortestArc_px);
}

/// Finds how far the middle of a ball's pixels may lie from the ball's centre. Noise moves each
/// place of the blob's outline by σ / slope, the grid by a pixel's share; a slope is about the
/// amplitude over 1.65 px. Uneven light draws the bright pixels aside by a share of the diameter.
double LargestOffset_px(const Blob& blob, double diameter_px) {
  constexpr double kEdgeWidth_px = 1.65;
  constexpr double kUnevenLight = 0.05;
  constexpr double kSigmas = 6;
  constexpr double kLargestShare = 0.12;  // what noise leads to in a small ball is no ball's centre
  const double noise_px = kEdgeWidth_px * blob.noise_dn / (blob.peak_dn - blob.background_dn);
  const double place_px2 = noise_px * noise_px + kPixelVariance_px2;
  const double sigma_px = std::sqrt(2 * place_px2 / (kPi * diameter_px));
  return std::min(kUnevenLight * diameter_px + kSigmas * sigma_px, kLargestShare * diameter_px);
}

/// Tells whether a whole outline does not surround its blob: noise can lead a fit across a small
/// ball or one end of a smeared one, and two merged balls have one blob.
bool IsBesideBlob(const Blob& blob, const Outline& outline, const BallObservation& ball) {
  constexpr double kSmallestShare =
      0.6;  // of the blob's area: a blob found in smoothed light is larger
  if (kPi * ball.semi_major_px * ball.semi_minor_px < kSmallestShare * blob.area_px) return true;
  const Eigen::Vector2d middle_px(blob.sum_u / blob.area_px, blob.sum_v / blob.area_px);
  return outline.visible_share > kWhole &&
         (ball.center_px - middle_px).norm() > LargestOffset_px(blob, ball.diameter_px());
}

/// Tells whether the ball moved too far while the image was exposed for its edges to be edges.
bool IsSmeared(const Blob& blob, const WaveletPatch& patch, const Outline& outline,
               const BallObservation& ball) {
  // In focus or a little out of it: 1.3 px for a ball of 6 px, where noise leads to 1.2 px at 15
  // dB.
  const double largest_blur_px = 0.7 + 0.1 * ball.diameter_px();
  return outline.blur_px > largest_blur_px || !(outline.steepness_wave < kLargestSteepnessWave) ||
         UnevennessAround(patch, outline.ellipse, blob.noise_dn) >
             kLargestUnevenness * ball.amplitude_dn;
}

BlobStatus Judge(const ImageView& image, const Blob& blob, const WaveletPatch& patch,
                 const Outline& outline, const BallObservation& ball,
                 const DetectionOptions& options) {
  if (TouchesBorder(image, ball)) return BlobStatus::kClipped;
  if (IsBurntOut(patch)) return BlobStatus::kSaturated;
  const double smallest_ratio = std::max(options.min_axis_ratio, kSmallestAxisRatio);
  if (ball.semi_minor_px < smallest_ratio * ball.semi_major_px) return BlobStatus::kPartly;
  if (IsSmeared(blob, patch, outline, ball)) return BlobStatus::kPartly;
  if (IsArcTooShort(outline) || IsBesideBlob(blob, outline, ball)) return BlobStatus::kPartly;
  const double signal_to_noise_db =
      20 * std::log10(std::max(ball.amplitude_dn, 1e-9) / blob.noise_dn);
  if (signal_to_noise_db < options.min_signal_to_noise_db) return BlobStatus::kPoorFit;
  const double limit = LargestChi2Dof(
      outline.dof, std::min(options.max_chi2_probability_exponent, kLargestChi2Exponent));
  const double misfit_px =
      outline.rms_distance_px * std::sqrt(1 - 1 / std::max(ball.chi2_dof, 1.0));
  const bool is_explained = ball.chi2_dof <= limit || misfit_px < kLargestMisfit_px;
  return is_explained ? BlobStatus::kOk : BlobStatus::kPoorFit;
}

}  // namespace

bool IsBurntOut(const WaveletPatch& patch) {
  return patch.saturated_share > kLargestSaturatedShare;
}

BallObservation ClassifyOutline(const ImageView& image, const Blob& blob, const WaveletPatch& patch,
                                const Outline& outline, const DetectionOptions& options) {
  BallObservation ball;
  CopyOutline(outline, patch.origin_px, ball);
  const Inside inside = LookInside(patch, outline, 0.5 * (blob.peak_dn + blob.background_dn));
  ball.background_dn = blob.background_dn;
  ball.amplitude_dn = inside.mean_dn - blob.background_dn;
  ball.visible_fraction = inside.bright_share;
  ball.status = Judge(image, blob, patch, outline, ball, options);
  return ball;
}

}  // namespace stereomotion
