#include "stereomotion/pipeline/level_histogram.h"

#include <gtest/gtest.h>

namespace stereomotion::testing {
namespace {

constexpr double kHalfAStep = 0.022;  // 2^(1/32) - 1

TEST(LevelHistogram, QuantilesOfAKnownDistribution) {
  LevelHistogram histogram;
  EXPECT_FALSE(histogram.Quantile(0.99));
  for (int i = 1; i <= 10000; ++i) histogram.Add(0.01 * i);
  EXPECT_NEAR(*histogram.Median(), 50, kHalfAStep * 50);
  EXPECT_NEAR(*histogram.Quantile(0.99), 99, kHalfAStep * 99);
  EXPECT_NEAR(*histogram.Quantile(0.01), 1, kHalfAStep);
  EXPECT_EQ(*histogram.Quantile(0.5), *histogram.Median());
}

TEST(LevelHistogram, OneLevelIsEveryQuantile) {
  LevelHistogram histogram;
  histogram.Add(7);
  EXPECT_NEAR(*histogram.Quantile(0.01), 7, kHalfAStep * 7);
  EXPECT_NEAR(*histogram.Quantile(1), 7, kHalfAStep * 7);
}

}  // namespace
}  // namespace stereomotion::testing
