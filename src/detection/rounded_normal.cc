#include "rounded_normal.h"

#include <cmath>

#include "normal_distribution.h"

namespace stereomotion {
RoundedNormal RoundNormal(double mean, double variance) {
  constexpr double kReach_sigma = 7.5;
  const double sigma = std::sqrt(variance);
  const double first = std::floor(mean - kReach_sigma * sigma);
  const double last = std::ceil(mean + kReach_sigma * sigma);
  double m1 = 0, m2 = 0, m3 = 0, m4 = 0;  // about `mean`
  double below = NormalCdf((first - 0.5 - mean) / sigma);
  for (double k = first; k <= last; ++k) {
    const double up_to = NormalCdf((k + 0.5 - mean) / sigma);
    const double p = up_to - below;
    below = up_to;
    const double d = k - mean;
    m1 += p * d;
    m2 += p * d * d;
    m3 += p * d * d * d;
    m4 += p * d * d * d * d;
  }
  const double central2 = m2 - m1 * m1;
  const double central4 = m4 - 4 * m1 * m3 + 6 * m1 * m1 * m2 - 3 * m1 * m1 * m1 * m1;
  return {mean + m1, central2, central4 - central2 * central2};
}

}  // namespace stereomotion
