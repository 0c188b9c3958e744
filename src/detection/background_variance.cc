#include "background_variance.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>

#include "normal_distribution.h"
#include "rounded_normal.h"

namespace stereomotion {
namespace {

/// A cell that scatters this much more than expected shows an edge, a ball or a rod.
constexpr double kLargestScatterRatio = 2;
/// Independent differences of neighbours in a cell's stretch of 32 pixels (von Neumann 1941: 2/3 of
/// 31).
constexpr int kPixelsPerCell = 20;
/// Closer to grey value 0 than this too much of the noise is cut off to be made good.
constexpr double kDarkest_sigma = 1.0;
/// Below this variance [DN²] rounding does not simply add 1/12.
constexpr double kCoarse_dn2 = 0.6;
/// With so much variance before rounding [DN²] 32 pixels do not come out all alike (p < 1e-3): a
/// cell that does was painted, not measured.
constexpr double kNeverConstant_dn2 = 0.15;
/// So far above 0 nothing of the noise is cut off.
constexpr double kUnclipped_sigma = 4;
/// A cell's level is a mean of 32 whole numbers.
constexpr double kLevelsPerDn = BackgroundMap::kChunk_px;

/// Holds what is left of a normal distribution when its negative part is recorded as 0.
struct ClippedNormal {
  double mean_sigma;      ///< mean / σ after clipping
  double variance_ratio;  ///< variance / σ² after clipping
};

/// Clips a normal distribution whose mean is `alpha` σ at zero (Greene, Econometric Analysis, ch.
/// 19).
ClippedNormal ClipAtZero(double alpha) {
  const double above = NormalCdf(alpha);
  const double density = NormalDensity(alpha);
  const double mean = alpha * above + density;
  return {mean, (alpha * alpha + 1) * above + alpha * density - mean * mean};
}

/// What rounding makes of the expected noise at one level, linearised in its variance.
struct Rounding {
  double mean_dn = 0;       ///< before rounding
  double light_dn2 = 0;     ///< expected variance before rounding
  double variance_dn2 = 0;  ///< expected variance after it
  double squares_variance_dn4 = 0;
  double slope = 0;  ///< d variance after / d variance before
};

constexpr double kSheppard_dn2 = 1.0 / 12.0;

Rounding RoundedAt(double level_dn, double expected_dn2) {
  constexpr double kSmallest_dn2 = 1e-3;
  Rounding at;
  at.light_dn2 = std::max(expected_dn2 - kSheppard_dn2, kSmallest_dn2);
  at.mean_dn = level_dn;
  for (int k = 0; k < 3; ++k) at.mean_dn += level_dn - RoundNormal(at.mean_dn, at.light_dn2).mean;
  const RoundedNormal rounded = RoundNormal(at.mean_dn, at.light_dn2);
  at.variance_dn2 = rounded.variance;
  at.squares_variance_dn4 = rounded.squares_variance;
  const double step_dn2 = 0.05 * at.light_dn2;
  at.slope = (RoundNormal(at.mean_dn, at.light_dn2 + step_dn2).variance -
              RoundNormal(at.mean_dn, at.light_dn2 - step_dn2).variance) /
             (2 * step_dn2);
  return at;
}

/// Adds a cell whose noise is so small that the place of its level between two grey values decides
/// how much rounding adds (less than nothing at a whole one). One that rounding has made blind to
/// the noise weighs nothing.
void AddRounded(const Rounding& at, double variance_dn2, VarianceLine& line) {
  constexpr double kBlind = 0.2;
  if (at.slope < kBlind) return;
  line.Add(at.mean_dn, at.light_dn2 + kSheppard_dn2 + (variance_dn2 - at.variance_dn2) / at.slope,
           std::sqrt(at.squares_variance_dn4 / 2) / at.slope, kPixelsPerCell);
}

}  // namespace

void AddBackgroundVariance(const BackgroundMap& map, const SensorNoise& noise, VarianceLine& line) {
  std::map<std::int64_t, Rounding> rounding;  // many cells share a level
  for (std::size_t i = 0; i < map.level_dn.size(); ++i) {
    const double expected = noise.VarianceDn2(map.raw_level_dn[i]);
    if (map.raw_variance_dn2[i] == 0 && expected - kSheppard_dn2 > kNeverConstant_dn2) continue;
    const double sigma = std::sqrt(expected);
    const double raw_alpha = map.raw_level_dn[i] / sigma;
    double alpha = raw_alpha;
    for (int k = 0; k < 3; ++k) alpha += raw_alpha - ClipAtZero(alpha).mean_sigma;
    if (alpha < kDarkest_sigma) continue;
    const double variance = map.raw_variance_dn2[i] / ClipAtZero(alpha).variance_ratio;
    if (variance > kLargestScatterRatio * expected) continue;
    if (expected >= kCoarse_dn2 || alpha <= kUnclipped_sigma) {
      line.Add(alpha * sigma, variance, expected, kPixelsPerCell);
      continue;
    }
    const std::int64_t level = std::lround(alpha * sigma * kLevelsPerDn);
    auto known = rounding.find(level);
    if (known == rounding.end()) {
      const double level_dn = static_cast<double>(level) / kLevelsPerDn;
      known = rounding.emplace(level, RoundedAt(level_dn, noise.VarianceDn2(level_dn))).first;
    }
    AddRounded(known->second, variance, line);
  }
}

}  // namespace stereomotion
