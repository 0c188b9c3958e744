#include "src/detection/pixel_order.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

/// What the fit of a smear relies on: the range holds every pixel in reach, and each pixel keeps
/// its grey value.
TEST(PixelOrder, RangesHoldAllPixelsInReach) {
  constexpr int kSize = 400;
  constexpr double kReach_px = 3;
  auto rng = testing::MakeTestRng();
  Eigen::ArrayXf u(kSize), v(kSize), grey(kSize);
  for (int i = 0; i < kSize; ++i) {
    u[i] = static_cast<float>(testing::Uniform(rng, -15, 15));
    v[i] = static_cast<float>(testing::Uniform(rng, -15, 15));
    grey[i] = 100 * u[i] + v[i];
  }
  PixelOrder order;
  EXPECT_EQ(order.Near({0, 0}, kReach_px, kSize).end, kSize);
  const Eigen::Vector2f direction(0.6F, -0.8F);
  order.Sort(direction, kSize, u, v, grey);
  for (const float along : {-30.0F, -7.3F, 0.0F, 12.5F, 30.0F}) {
    const Eigen::Vector2f point = along * direction;
    const PixelRange range = order.Near(point, kReach_px, kSize);
    for (int i = 0; i < kSize; ++i) {
      const bool in_range = i >= range.begin && i < range.end;
      const bool in_reach = std::hypot(u[i] - point.x(), v[i] - point.y()) <= kReach_px;
      EXPECT_TRUE(in_range || !in_reach) << i;
      EXPECT_EQ(grey[i], 100 * u[i] + v[i]);
    }
    EXPECT_LT(range.end - range.begin, kSize / 2);
  }
}

}  // namespace
}  // namespace stereomotion
