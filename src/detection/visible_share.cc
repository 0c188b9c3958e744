#include "visible_share.h"

#include <algorithm>
#include <cmath>

namespace stereomotion {
namespace {

using P = BallModel;

/// Says from which predicted height on a pixel is clearly ball, a share of the brightest: light
/// that a smear spreads has no depth inside a limb.
constexpr float kDeepShare = 0.75F;
/// A pixel at the limb is half bright by itself: one blur width inwards it is clearly ball.
constexpr float kDeep_blurs = 1.0F;

/// Height over the fitted background.
float Over(const BallPatch& patch, const Eigen::Vector3f& plane, float grey, int i) {
  return grey - plane[0] - plane[1] * patch.u[i] - plane[2] * patch.v[i];
}

}  // namespace

void MeasureVisible(const SensorNoise& noise, const FittedBall& best, const BallPatch& patch,
                    BallFit& fit) {
  const Eigen::Vector3f plane = best.search.at.segment<3>(P::kLevel).cast<float>();
  float brightest = 0;
  for (int i = 0; best.terms.smear && i < patch.size; ++i) {
    brightest = std::max(brightest, Over(patch, plane, patch.model[i], i));
  }
  int deep = 0, bright = 0;
  double sum_dn = 0;
  for (int i = 0; i < patch.size; ++i) {
    if (!best.terms.smear && patch.depth[i] <= kDeep_blurs) continue;
    const float expected = Over(patch, plane, patch.model[i], i);
    if (expected <= kDeepShare * brightest) continue;
    ++deep;
    sum_dn += expected;
    bright += Over(patch, plane, patch.grey[i], i) > 0.5F * expected ? 1 : 0;
  }
  if (deep == 0) return;
  // Noise alone dims so many pixels of the ball below half, and lifts so many of what hides it.
  const double height_dn = sum_dn / deep;
  const double level_dn = plane[0];
  const auto beyond_half = [&](double mean_dn) {
    return 0.5 * std::erfc(0.5 * height_dn / std::sqrt(2 * noise.VarianceDn2(mean_dn)));
  };
  const double dimmed = beyond_half(level_dn + height_dn);
  const double told = std::max(1 - dimmed - beyond_half(level_dn), 0.1);
  const double share = (static_cast<double>(bright) / deep - beyond_half(level_dn)) / told;
  fit.visible_fraction = std::clamp(share, 0.0, 1.0);
  fit.visible_sigma = std::sqrt(dimmed * (1 - dimmed) / deep) / told;
}

}  // namespace stereomotion
