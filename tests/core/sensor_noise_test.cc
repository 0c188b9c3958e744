#include "stereomotion/core/sensor_noise.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

TEST(SensorNoise, ExactVariance) {
  const SensorNoise noise{50, 10, 4, 255};
  EXPECT_NEAR(noise.VarianceDn2(104), 100.0 / 50 + 0.04 + 1.0 / 12, 1e-15);
}

TEST(SensorNoise, BelowBlackOnlyReadNoiseAndQuantisation) {
  const SensorNoise noise{50, 10, 4, 255};
  EXPECT_EQ(noise.VarianceDn2(4), noise.VarianceDn2(-3));
  EXPECT_NEAR(noise.VarianceDn2(4), 0.04 + 1.0 / 12, 1e-15);
}

TEST(SensorNoise, PredictsSpreadOfSimulatedPixels) {
  // Poisson electrons, Gaussian read noise, rounding: the law that the formula claims.
  const SensorNoise noise{20, 8, 2, 255};
  auto rng = testing::MakeTestRng();
  std::poisson_distribution<int> electrons(60.3 * noise.gain_e_per_dn);
  constexpr int kCount = 40000;
  double sum = 0, sum2 = 0;
  for (int i = 0; i < kCount; ++i) {
    const double read_e = noise.read_e * testing::Normal(rng);
    const double dn = std::round(noise.black_dn + (electrons(rng) + read_e) / noise.gain_e_per_dn);
    sum += dn;
    sum2 += dn * dn;
  }
  const double mean = sum / kCount, variance = sum2 / kCount - mean * mean;
  // A variance estimated from n normal numbers has relative σ √(2/n); 5 of them.
  EXPECT_NEAR(variance / noise.VarianceDn2(62.3), 1, 5 * std::sqrt(2.0 / kCount));
}

}  // namespace
}  // namespace stereomotion
