#include "ball_pulls.h"

#include <cmath>

namespace stereomotion {
namespace {

using P = BallModel;

/// The limb's shading is nearly one with blur, radius and amplitude where a ball is small or dim.
constexpr double kUsualShading = 0.15;
constexpr double kUsualShadingSpread = 0.15;
/// Perspective stretches a ball's outline by a few hundredths.
constexpr double kUsualStretchSpread = 0.05;
/// Blurs differ by focus. Balls out of focus lie far off …
constexpr double kUsualBlurSpread_px = 0.1;
/// … by so many standard deviations; so far noise takes one in 400.
constexpr double kFar_sigma = 3;

}  // namespace

Pulls::Pulls() {
  usual[P::kShading] = kUsualShading;
  weight[P::kShading] = 1 / (kUsualShadingSpread * kUsualShadingSpread);
  for (const int k : {P::kStretch1, P::kStretch2}) {
    weight[k] = 1 / (kUsualStretchSpread * kUsualStretchSpread);
  }
  usual[P::kBlur] = kUsualBlur_px;
  weight[P::kBlur] = 1 / (kUsualBlurSpread_px * kUsualBlurSpread_px);
}

bool Pulls::LoosenBlur(const FitParameters::Vector& at, double variance_px2) {
  // Where the data alone would have it.
  const double off_px =
      std::abs(at[P::kBlur] - kUsualBlur_px) * (1 + variance_px2 * weight[P::kBlur]);
  const double usual_px2 = kUsualBlurSpread_px * kUsualBlurSpread_px;
  if (off_px < kFar_sigma * std::sqrt(usual_px2 + variance_px2)) return false;
  weight[P::kBlur] = 1 / (usual_px2 + off_px * off_px);
  return true;
}

}  // namespace stereomotion
