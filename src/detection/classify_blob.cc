#include "classify_blob.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "chi2_limit.h"
#include "image_border.h"
#include "normal_distribution.h"
#include "pixel_variance.h"

namespace stereomotion {
namespace {

/// A blob thinner than this, by its moments, is a wire or a streak.
constexpr double kThinnestAxisRatio = 0.25;
/// A longer smear is rather a wire.
constexpr double kLongestSmear_diameters = 2.5;
/// A ball of 6 px at 10 dB, the faintest to be found, has 0.05; beyond this the errors are no
/// longer Gaussian, and most things that are so uncertain are no balls.
constexpr double kLargestSigma_diameters = 0.1;
/// A fit smaller than so much of the smallest ball is a speck, as `MayBeBall` judges blobs.
constexpr double kSmallestFit = 0.7;
/// Less than this share of a ball bright: something stands before it.
constexpr double kSmallestVisibleFraction = 0.9;
/// … by so many standard deviations: the binomial's tail is longer than the normal one's.
constexpr double kVisible_sigma = 4;
/// Excess of the residuals over the noise, in units of the background's noise, against the
/// amplitude, that no real lens explains. (At the limb, where a misfit sits, the noise is about
/// twice the background's.)
constexpr double kLargestMisfit = 0.02;

struct Moments {
  Eigen::Vector2d center_px;
  double major_px, minor_px, angle_rad;  ///< semi-axes of the ellipse of equal moments
};

Moments MomentsOf(const Blob& blob) {
  const double n = blob.area_px;
  const Eigen::Vector2d mean(blob.sum_u / n, blob.sum_v / n);
  Eigen::Matrix2d second;
  second(0, 0) = blob.sum_uu / n - mean.x() * mean.x() + kPixelVariance_px2;
  second(1, 1) = blob.sum_vv / n - mean.y() * mean.y() + kPixelVariance_px2;
  second(0, 1) = second(1, 0) = blob.sum_uv / n - mean.x() * mean.y();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen;
  eigen.computeDirect(second);
  const Eigen::Vector2d axis = eigen.eigenvectors().col(1);
  return {mean, 2 * std::sqrt(std::max(eigen.eigenvalues()[1], 0.0)),
          2 * std::sqrt(std::max(eigen.eigenvalues()[0], 0.0)), std::atan2(axis.y(), axis.x())};
}

/// Mean grey value of a square of pixels; noise hides what a single one shows of a weak blob.
double GreyAt(const ImageView& image, int u, int v, int reach_px) {
  double sum = 0;
  int count = 0;
  for (int y = std::max(v - reach_px, 0); y <= std::min(v + reach_px, image.height_px - 1); ++y) {
    for (int x = std::max(u - reach_px, 0); x <= std::min(u + reach_px, image.width_px - 1); ++x) {
      sum += image.At(x, y);
      ++count;
    }
  }
  return sum / count;
}

/// Tells whether it is dark around the blob. A neighbour may fill a quarter of the ring.
bool IsIsland(const ImageView& image, const Blob& blob, const Moments& moments) {
  constexpr int kSamples = 16;
  constexpr double kTail_px = 3;  // beyond the limb's blur
  const double half_dn = 0.5 * (blob.peak_dn + blob.background_dn);
  const double cosine = std::cos(moments.angle_rad);
  const double sine = std::sin(moments.angle_rad);
  int bright = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double angle = 2 * kPi * i / kSamples;
    const double x = (moments.major_px + kTail_px) * std::cos(angle);
    const double y = (moments.minor_px + kTail_px) * std::sin(angle);
    const auto u = static_cast<int>(std::lround(moments.center_px.x() + cosine * x - sine * y));
    const auto v = static_cast<int>(std::lround(moments.center_px.y() + sine * x + cosine * y));
    const bool inside = u >= 0 && v >= 0 && u < image.width_px && v < image.height_px;
    if (inside && GreyAt(image, u, v, blob.is_weak ? 1 : 0) > half_dn) ++bright;
  }
  return bright <= kSamples / 4;
}

double HalfTurn(double angle_rad) {
  if (angle_rad > kPi / 2) return angle_rad - kPi;
  if (angle_rad <= -kPi / 2) return angle_rad + kPi;
  return angle_rad;
}

void CopyFit(const BallFit& fit, const Eigen::Vector2d& origin_px, BallObservation& ball) {
  using P = BallModel;
  const auto& p = fit.model.values;
  ball.center_px = origin_px + p.head<2>();
  ball.covariance_px2 = fit.covariance.topLeftCorner<2, 2>();
  const double stretch = std::hypot(p[P::kStretch1], p[P::kStretch2]);
  // The blur pulls the fitted straight edge of a round limb inwards by σ²/2R (curvature flow).
  const double radius = p[P::kRadius] + p[P::kBlur] * p[P::kBlur] / (2 * p[P::kRadius]);
  ball.semi_major_px = radius / std::sqrt(1 - 2 * stretch);
  ball.semi_minor_px = radius / std::sqrt(1 + 2 * stretch);
  ball.angle_rad = HalfTurn(0.5 * std::atan2(p[P::kStretch2], p[P::kStretch1]));
  ball.blur_px = std::sqrt(std::max(p[P::kBlur] * p[P::kBlur] - kPixelVariance_px2, 0.0));
  ball.amplitude_dn = p[P::kAmplitude];
  ball.background_dn = p[P::kLevel];
  ball.chi2_dof = fit.chi2 / fit.dof;
  ball.smear_px = fit.model.smear_px;
}

void CopyMoments(const Blob& blob, BallObservation& ball) {
  const Moments moments = MomentsOf(blob);
  ball.center_px = moments.center_px;
  ball.semi_major_px = moments.major_px;
  ball.semi_minor_px = moments.minor_px;
  ball.angle_rad = HalfTurn(moments.angle_rad);
  ball.amplitude_dn = blob.peak_dn - blob.background_dn;
  ball.background_dn = blob.background_dn;
}

bool TouchesBorder(const ImageView& image, const BallObservation& ball) {
  // One pixel more than the outline: the blurred limb must lie inside as well.
  const Eigen::Array2d reach = ball.semi_major_px + 1 + 0.5 * ball.smear_px.array().abs();
  return TouchesBorder(image, ball.center_px, reach);
}

/// Height of the ball's image: a smear longer than the ball spreads its light.
double BrightnessOf(const BallObservation& ball) {
  const double length_px = std::max(ball.smear_px.norm(), ball.diameter_px());
  return ball.amplitude_dn * ball.diameter_px() / length_px;
}

/// Tells whether the fit found a thing of a ball's size at a place that it knows.
bool IsDefinite(const BallObservation& ball, const DetectionOptions& options) {
  const double sigma_px = std::sqrt(ball.covariance_px2.trace() / 2);
  return sigma_px < kLargestSigma_diameters * ball.diameter_px() &&
         ball.diameter_px() > kSmallestFit * options.min_diameter_px;
}

BlobStatus Judge(const ImageView& image, const Blob& blob, const BallFit& fit,
                 const BallObservation& ball, const DetectionOptions& options) {
  if (TouchesBorder(image, ball)) return BlobStatus::kClipped;
  if (fit.dof <= 0) return BlobStatus::kSaturated;
  if (!fit.converged || !IsDefinite(ball, options)) return BlobStatus::kPoorFit;
  if (ball.semi_minor_px < options.min_axis_ratio * ball.semi_major_px) return BlobStatus::kPartly;
  if (ball.smear_px.norm() > kLongestSmear_diameters * ball.diameter_px()) {
    return BlobStatus::kPartly;
  }
  if (ball.visible_fraction < kSmallestVisibleFraction - kVisible_sigma * fit.visible_sigma) {
    return BlobStatus::kPartly;
  }
  const double signal_to_noise_db =
      20 * std::log10(std::max(BrightnessOf(ball), 1e-9) / blob.noise_dn);
  if (signal_to_noise_db < options.min_signal_to_noise_db) return BlobStatus::kPoorFit;
  const double limit = LargestChi2Dof(fit.dof, options.max_chi2_probability_exponent);
  if (ball.chi2_dof <= limit) return BlobStatus::kOk;
  // χ² beyond the noise's reach: still a ball where the misfit is small against its brightness (a
  // lens is not exactly Gaussian); a hidden part or a neighbour leaves far more.
  const double misfit = std::sqrt(ball.chi2_dof - 1) * blob.noise_dn / BrightnessOf(ball);
  return misfit < kLargestMisfit ? BlobStatus::kOk : BlobStatus::kPoorFit;
}

/// How clearly a blob stands out: its contrast in units of the noise, averaged over its area.
double Clarity(const Blob& blob) {
  return (blob.peak_dn - blob.background_dn) / blob.noise_dn * std::sqrt(blob.area_px);
}

}  // namespace

bool MayBeBall(const ImageView& image, const Blob& blob, const DetectionOptions& options) {
  const double diameter = 2 * std::sqrt(blob.area_px / kPi);
  if (diameter < 0.7 * options.min_diameter_px || diameter > options.max_diameter_px) return false;
  const Moments moments = MomentsOf(blob);
  return moments.minor_px > kThinnestAxisRatio * moments.major_px && IsIsland(image, blob, moments);
}

void ChooseCandidates(const ImageView& image, const std::vector<Blob>& blobs,
                      const DetectionOptions& options, std::vector<const Blob*>& candidates) {
  candidates.clear();
  for (const Blob& blob : blobs) {
    if (MayBeBall(image, blob, options)) candidates.push_back(&blob);
  }
  if (static_cast<int>(candidates.size()) <= options.max_balls) return;
  const auto end = candidates.begin() + options.max_balls;
  std::nth_element(candidates.begin(), end, candidates.end(), [](const Blob* a, const Blob* b) {
    const double clarity_a = Clarity(*a);
    const double clarity_b = Clarity(*b);
    return clarity_a != clarity_b ? clarity_a > clarity_b : a->label < b->label;
  });
  candidates.erase(end, candidates.end());
}

BallObservation ClassifyBall(const ImageView& image, const Blob& blob, const BallFit& fit,
                             const Eigen::Vector2d& origin_px, const DetectionOptions& options) {
  BallObservation ball;
  const Moments moments = MomentsOf(blob);
  const Eigen::Vector2d fitted_px = origin_px + fit.model.values.head<2>();
  if (fit.converged && (fitted_px - moments.center_px).norm() < 0.5 * moments.major_px + 0.5) {
    CopyFit(fit, origin_px, ball);
    ball.visible_fraction = fit.visible_fraction;
    ball.status = Judge(image, blob, fit, ball, options);
  } else {
    CopyMoments(blob, ball);
    ball.status = TouchesBorder(image, ball) ? BlobStatus::kClipped : BlobStatus::kPoorFit;
  }
  return ball;
}

}  // namespace stereomotion
