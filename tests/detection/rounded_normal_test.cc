#include "src/detection/rounded_normal.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

TEST(RoundNormal, WideDistributionGainsSheppardsTwelfth) {
  for (const double mean : {4.0, 4.3, 4.5}) {
    const RoundedNormal rounded = RoundNormal(mean, 2.0);
    EXPECT_NEAR(rounded.mean, mean, 1e-9);
    EXPECT_NEAR(rounded.variance, 2.0 + 1.0 / 12, 1e-9);
  }
}

TEST(RoundNormal, NarrowDistributionIsDecidedByItsMean) {
  EXPECT_NEAR(RoundNormal(4.0, 0.01).variance, 0, 1e-5);
  EXPECT_NEAR(RoundNormal(4.5, 0.01).variance, 0.25, 1e-9);
  EXPECT_NEAR(RoundNormal(4.5, 0.01).squares_variance, 0, 1e-9);
}

TEST(RoundNormal, AgreesWithDrawnNumbers) {
  auto rng = testing::MakeTestRng();
  const double mean = 4.2;
  const double variance = 0.0865;
  const RoundedNormal rounded = RoundNormal(mean, variance);
  constexpr int kDraws = 200000;
  double sum = 0, squares = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double drawn = std::round(mean + std::sqrt(variance) * testing::Normal(rng));
    sum += drawn;
    squares += (drawn - rounded.mean) * (drawn - rounded.mean);
  }
  EXPECT_NEAR(sum / kDraws, rounded.mean, 4 * std::sqrt(rounded.variance / kDraws));
  EXPECT_NEAR(squares / kDraws, rounded.variance, 4 * std::sqrt(rounded.squares_variance / kDraws));
}

}  // namespace
}  // namespace stereomotion
