#include "censored_normal.h"

#include <algorithm>
#include <cmath>

#include "normal_distribution.h"

namespace stereomotion {
namespace {

/// Below it Φ loses its digits; the asymptotic series holds.
constexpr double kFarOutside = -5;

/// Computes −a + φ(a)/Φ(a) less −a … that is λ(a) + a, for a far below zero (Laplace's continued
/// fraction).
double TailExcess(double a) {
  const double t = -a;
  double fraction = t;
  for (int k = 8; k >= 2; --k) fraction = t + k / fraction;
  return 1 / fraction;
}

}  // namespace

CensoredNormal CensorNormal(double inside, double variance) {
  const double sigma = std::sqrt(std::max(variance, 1.0 / 12.0));
  const double a = inside / sigma;
  double ratio;   // φ/Φ
  double excess;  // φ/Φ + a
  double deviance;
  if (a > kFarOutside) {
    const double probability = NormalCdf(a);
    ratio = NormalDensity(a) / probability;
    excess = ratio + a;
    deviance = -2 * std::log(probability);
  } else {
    excess = TailExcess(a);
    ratio = excess - a;
    deviance = a * a + std::log(2 * kPi) + 2 * std::log(ratio);
  }
  // Not quite zero: the working residual divides by it.
  const double information = std::max(ratio * excess, 1e-12);
  return {ratio / sigma, information / (sigma * sigma), deviance, 1 - a * ratio};
}

}  // namespace stereomotion
