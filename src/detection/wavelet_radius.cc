#include "wavelet_radius.h"

#include "wavelet_locator.h"

namespace stereomotion {
namespace {

/// Computes I₁(z) / I₀(z) of the modified Bessel functions (Gauss' continued fraction; for large z
/// its asymptotic series).
double BesselRatio(double z) {
  constexpr double kLarge = 12;
  constexpr int kTerms = 24;
  if (z > kLarge) return 1 - 1 / (2 * z) - 1 / (8 * z * z) - 1 / (8 * z * z * z);
  double ratio = 0;
  for (int k = kTerms; k > 0; --k) ratio = 1 / (2 * k / z + ratio);
  return ratio;
}

}  // namespace

double UnbiasedRadius(double radius_px, double blur_px) {
  constexpr double kCoarseVariance_px2 = 3.75 + 4.0 / 3.0 + 1.0 / 2.0;
  constexpr int kIterations = 12;
  const double blur2 = blur_px * blur_px;
  const double fine2 = blur2 + EdgeLocator::kFineVariance_px2;
  const double coarse2 = blur2 + kCoarseVariance_px2;
  const double r = radius_px;
  double radius = r;
  for (int i = 0; i < kIterations; ++i) {
    const double pull = 1 / (fine2 * BesselRatio(r * radius / fine2)) +
                        1 / (coarse2 * BesselRatio(r * radius / coarse2));
    radius = (r / fine2 + r / coarse2 + 2 / r) / pull;
  }
  return radius;
}

}  // namespace stereomotion
