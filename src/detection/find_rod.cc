#include "find_rod.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "normal_distribution.h"

namespace stereomotion {
namespace {

/// Directions that are tried: 7.5° apart, a rod's width at the patch's border.
constexpr int kDirections = 48;
/// Half-width of the ray that is summed [px]: a thin rod and its blur.
constexpr double kRay_px = 1.6;
/// A rod stands out of the noise this far along one ray, at least; of 48 rays noise alone reaches
/// it once in 1e4 balls.
constexpr double kEvident_sigma = 4.5;

struct Ray {
  double outside = 0, outside_information = 0;  ///< beyond the limb: Σ r w, Σ w
  double limb = 0, limb_information = 0;        ///< within a blur of it

  [[nodiscard]] double OutsideSigma() const {
    return outside / std::sqrt(std::max(outside_information, 1e-30));
  }
  [[nodiscard]] double LimbSigma() const {
    return limb / std::sqrt(std::max(limb_information, 1e-30));
  }
  [[nodiscard]] double Evidence() const {
    return OutsideSigma() * OutsideSigma() + LimbSigma() * LimbSigma();
  }
};

using Rays = std::array<Ray, kDirections>;

/// Sums the residuals along rays from the ball's centre.
Rays SumRays(const BallModel& ball, const BallPatch& patch) {
  using P = BallModel;
  const double blur = ball.values[P::kBlur];
  const double radius = ball.values[P::kRadius];
  Rays rays;
  for (int i = 0; i < patch.size; ++i) {
    const double x = patch.u[i] - ball.values[P::kU];
    const double y = patch.v[i] - ball.values[P::kV];
    const double r = std::hypot(x, y);
    if (r < radius - 3 * blur || r < kRay_px) continue;
    const bool outside = r > radius + 1.5 * blur;
    const double residual = (patch.grey[i] - patch.model[i]) * patch.weight[i];
    const double angle = std::atan2(y, x);
    const double half_angle = std::asin(std::min(kRay_px / r, 1.0));
    const double per_step = kDirections / (2 * kPi);
    const int first = static_cast<int>(std::ceil((angle - half_angle) * per_step));
    const int last = static_cast<int>(std::floor((angle + half_angle) * per_step));
    for (int k = first; k <= last; ++k) {
      Ray& ray = rays[static_cast<std::size_t>((k + kDirections) % kDirections)];
      (outside ? ray.outside : ray.limb) += residual;
      (outside ? ray.outside_information : ray.limb_information) += patch.weight[i];
    }
  }
  return rays;
}

}  // namespace

bool FindRod(const BallModel& ball, const BallPatch& patch, RodModel& rod) {
  const Rays rays = SumRays(ball, patch);
  const auto best = std::max_element(rays.begin(), rays.end(), [](const Ray& a, const Ray& b) {
    return a.Evidence() < b.Evidence();
  });
  if (best->Evidence() < kEvident_sigma * kEvident_sigma) return false;
  const auto ahead = static_cast<int>(best - rays.begin());
  // The rod's other end lies opposite, to a step or two.
  const Ray* other = nullptr;
  for (int k = -2; k <= 2; ++k) {
    const Ray& ray = rays[static_cast<std::size_t>((ahead + kDirections / 2 + k) % kDirections)];
    if (other == nullptr || ray.Evidence() > other->Evidence()) other = &ray;
  }
  rod.values[RodModel::kAngle] = 2 * kPi * ahead / kDirections;
  rod.values[RodModel::kOffset] = 0;
  rod.values[RodModel::kHalfWidth] = std::min(1.5, 0.3 * ball.values[BallModel::kRadius]);
  rod.values[RodModel::kContrast] = best->outside / std::max(best->outside_information, 1e-30);
  rod.values[RodModel::kLean] = 0;
  rod.values[RodModel::kSetback] = 0.2;
  rod.ahead = true;
  rod.behind = std::abs(other->OutsideSigma()) > kEvident_sigma;
  return true;
}

}  // namespace stereomotion
