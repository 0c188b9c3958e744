#include "ball_fitter.h"

#include <algorithm>
#include <cmath>

#include "normal_distribution.h"
#include "start_ball.h"

namespace stereomotion {
namespace {

using P = BallModel;

/// Blur's tail around the half-height box that is fitted pixel by pixel: five standard deviations
/// of a usual lens.
constexpr double kUsualTail_px = 3.5;
/// Where the ball's light has fallen to 1e-5 of its amplitude.
constexpr double kTail_blurs = 4.3;
/// Background kept beyond the tail, growing with the ball: its level and slopes then cost the
/// centre 1–2 % of its precision.
constexpr double kNarrowestRing_px = 5.5;
constexpr double kWidestRing_px = 10;
constexpr double kRing_radii = 0.8;
constexpr double kWidestTail_px = 20;

double RingOf(const Blob& blob) {
  return std::clamp(kRing_radii * std::sqrt(blob.area_px / kPi), kNarrowestRing_px, kWidestRing_px);
}

/// Finds how far around the part cut out the fitted ball's light reaches.
double TailOf(const BallFit& fit, const Blob& blob, const BallWindow& window) {
  const auto& p = fit.model.values;
  const double stretch = std::hypot(p[P::kStretch1], p[P::kStretch2]);
  const double radius = p[P::kRadius] / std::sqrt(1 - 2 * stretch);
  const Eigen::Vector2d middle_px(0.5 * (blob.u_min + blob.u_max), 0.5 * (blob.v_min + blob.v_max));
  const Eigen::Vector2d reach_px = (window.origin_px() + p.head<2>() - middle_px).cwiseAbs() +
                                   0.5 * fit.model.smear_px.cwiseAbs();
  return (reach_px - window.half_px()).maxCoeff() + radius + kTail_blurs * p[P::kBlur];
}

}  // namespace

const BallFit& BallFitter::Fit(const ImageView& image, const Segmenter& segments, const Blob& blob,
                               const SensorNoise& noise, const BallObservation* expected) {
  const double ring_px = RingOf(blob);
  window_.Cut(image, segments, blob, noise, {kUsualTail_px, ring_px}, patch_);
  fit_ = FitBall(noise, StartBall(patch_, blob, window_.origin_px(), expected), patch_);
  if (!fit_.converged) return fit_;
  const double tail_px = std::min(TailOf(fit_, blob, window_), kWidestTail_px);
  if (tail_px <= kUsualTail_px) return fit_;
  const int iterations = fit_.iterations;
  window_.Cut(image, segments, blob, noise, {tail_px, ring_px}, patch_);
  fit_ = FitBall(noise, fit_.model, patch_);
  fit_.iterations += iterations;
  return fit_;
}

BallPatch& BallFitter::CutWhole(const ImageView& image, const Segmenter& segments, const Blob& blob,
                                const SensorNoise& noise) {
  window_.Cut(image, segments, blob, noise, {kUsualTail_px + RingOf(blob), 0}, patch_);
  return patch_;
}

}  // namespace stereomotion
