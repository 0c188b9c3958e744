#include "wavelet_surround.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "normal_distribution.h"

namespace stereomotion {
namespace {

/// The ring begins where the limb's blur of 0.7 px has ended.
constexpr double kRingBegin_px = 1.5;
constexpr double kRingEnd_px = 3.5;
constexpr int kSides = 8;
/// Range of eight draws of noise, in σ: one time in fifteen it is larger.
constexpr double kRangeOfNoise = 4;

struct Side {
  double sum_dn = 0;
  int count = 0;
};
using Sides = std::array<Side, kSides>;

/// Gathers the pixels of the ring. (Distances along the line to the centre: Sampson's are too large
/// far from the outline.)
Sides GatherRing(const WaveletPatch& patch, const Ellipse& ellipse) {
  Sides sides;
  const Eigen::Matrix2d shape = ellipse.Shape();
  for (int v = 0; v < patch.grey_dn.height; ++v) {
    for (int u = 0; u < patch.grey_dn.width; ++u) {
      const Eigen::Vector2d x = Eigen::Vector2d(u, v) - ellipse.center();
      const double distance_px = x.norm() * (1 - ellipse.radius() / std::sqrt(x.dot(shape * x)));
      if (!(distance_px >= kRingBegin_px && distance_px <= kRingEnd_px)) continue;
      const double turn = std::atan2(x.y(), x.x()) / (2 * kPi) + 1;
      Side& side = sides[static_cast<std::size_t>(turn * kSides + 0.5) % kSides];
      side.sum_dn += patch.grey_dn.At(u, v);
      ++side.count;
    }
  }
  return sides;
}

}  // namespace

double UnevennessAround(const WaveletPatch& patch, const Ellipse& ellipse, double noise_dn) {
  double brightest_dn = -std::numeric_limits<double>::infinity();
  double darkest_dn = std::numeric_limits<double>::infinity();
  int fewest = std::numeric_limits<int>::max();
  for (const Side& side : GatherRing(patch, ellipse)) {
    if (side.count == 0) continue;
    brightest_dn = std::max(brightest_dn, side.sum_dn / side.count);
    darkest_dn = std::min(darkest_dn, side.sum_dn / side.count);
    fewest = std::min(fewest, side.count);
  }
  return brightest_dn - darkest_dn - kRangeOfNoise * noise_dn / std::sqrt(fewest);
}

}  // namespace stereomotion
