#include <algorithm>
#include <cmath>

#include "normal_distribution.h"
#include "wavelet_outline.h"

namespace stereomotion {
namespace {

/// Share by which a limb's steepness may depart from its waves: what stands before the limb, or
/// behind it, alters the steepness before it moves the edge.
constexpr double kUnlike = 0.05;
constexpr double kUnlikeSigmas = 4;
/// Where something cuts the outline, the corner draws the edge as far as two σ of the coarse
/// filter.
constexpr double kReach_px = 4.5;

}  // namespace

bool OutlineFitter::RejectOutliers(double sigmas, double slack_px) {
  const auto excess = [&](const Ray& ray) {
    return std::abs(ray.distance_px) / (sigmas * ray.sigma_px + slack_px);
  };
  double worst = 0;
  for (const Ray& ray : rays_) worst = std::max(worst, ray.is_used ? excess(ray) : 0.0);
  if (worst <= 1) return false;
  // Only the worst at once: they have drawn the fit off the others.
  for (Ray& ray : rays_) ray.is_used &= excess(ray) <= std::max(0.5 * worst, 1.0);
  return true;
}

void OutlineFitter::RejectUnlike() {
  slopes_.clear();
  for (const Ray& ray : rays_) {
    if (ray.is_used) slopes_.push_back({ray.edge.outward, ray.edge.fine.slope});
  }
  steepness_.Fit(slopes_);
  for (Ray& ray : rays_) {
    if (!ray.is_used) continue;
    const double usual = steepness_.At(ray.edge.outward);
    ray.is_used = std::abs(ray.edge.fine.slope - usual) <
                  kUnlike * usual + kUnlikeSigmas * ray.slope_sigma_dn_px;
  }
}

double OutlineFitter::MedianShift() {
  shifts_px_.clear();
  for (const Ray& ray : rays_) {
    if (ray.is_used) shifts_px_.push_back(ray.edge.shift_px);
  }
  if (shifts_px_.empty()) return 0;
  const auto middle = shifts_px_.begin() + static_cast<std::ptrdiff_t>(shifts_px_.size() / 2);
  std::nth_element(shifts_px_.begin(), middle, shifts_px_.end());
  return *middle;
}

bool OutlineFitter::IsExplained() const {
  // Twice: beyond what noise reaches once in 1000 outlines of 10 px or more.
  constexpr double kLargest = 2;
  double square_px2 = 0;
  double variance_px2 = 0;
  for (const Ray& ray : rays_) {
    if (!ray.is_used) continue;
    square_px2 += ray.distance_px * ray.distance_px;
    variance_px2 += ray.sigma_px * ray.sigma_px;
  }
  return square_px2 < kLargest * variance_px2;
}

void OutlineFitter::RejectNeighbours(double radius_px) {
  const int count = static_cast<int>(rays_.size());
  const double spacing_px = 2 * kPi * radius_px / count;
  const int reach = static_cast<int>(std::min(std::ceil(kReach_px / spacing_px), 0.5 * count));
  doubtful_.assign(rays_.size(), 0);
  for (int i = 0; i < count; ++i) {
    const auto next = static_cast<std::size_t>((i + 1) % count);
    // Whatever hides a limb hides more than one point; a single one was noise.
    if (rays_[static_cast<std::size_t>(i)].is_used || rays_[next].is_used) continue;
    for (int k = -reach; k <= reach + 1; ++k) {
      doubtful_[static_cast<std::size_t>((i + k + count) % count)] = 1;
    }
  }
  for (std::size_t i = 0; i < rays_.size(); ++i) rays_[i].is_used &= doubtful_[i] == 0;
}

}  // namespace stereomotion
