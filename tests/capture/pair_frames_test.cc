#include "stereomotion/capture/pair_frames.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using Times = std::vector<std::int64_t>;

TEST(MedianPeriod, IsNotMovedByOneGap) {
  EXPECT_EQ(MedianPeriodNs({0, 10, 20, 50, 60}), 10);
  EXPECT_EQ(MedianPeriodNs({7}), 0);
}

TEST(PairByTime, FindsPartnersAroundLostFrames) {
  EXPECT_EQ(PairByTime({0, 10, 20, 30}, {1, 21, 31}, 5), (Times{0, -1, 1, 2}));
}

TEST(PairByTime, ToleranceItselfIsOutside) {
  EXPECT_EQ(PairByTime({0}, {5}, 5), (Times{-1}));
  EXPECT_EQ(PairByTime({0}, {4}, 5), (Times{0}));
}

TEST(PairByTime, GivesOnePartnerToTheNearest) {
  EXPECT_EQ(PairByTime({0, 4}, {3}, 5), (Times{-1, 0}));
  EXPECT_EQ(PairByTime({0, 4}, {2}, 5), (Times{0, -1}));  // a tie goes to the earlier one
}

TEST(PairByTime, NoRightFrames) { EXPECT_EQ(PairByTime({0, 10}, {}, 5), (Times{-1, -1})); }

// Law: left and right are alike. Pairs found from the right are the pairs found from the left.
TEST(PairByTime, IsSymmetric) {
  auto rng = testing::MakeTestRng();
  for (int repetition = 0; repetition < 200; ++repetition) {
    Times left, right;
    for (int i = 0; i < 40; ++i) {
      if (testing::Uniform(rng, 0, 1) < 0.8)
        left.push_back(i * 100 + static_cast<std::int64_t>(testing::Uniform(rng, 0, 80)));
      if (testing::Uniform(rng, 0, 1) < 0.8)
        right.push_back(i * 100 + static_cast<std::int64_t>(testing::Uniform(rng, 0, 80)));
    }
    const Times forward = PairByTime(left, right, 50), backward = PairByTime(right, left, 50);
    for (std::size_t i = 0; i < forward.size(); ++i) {
      if (forward[i] < 0) {
        EXPECT_EQ(std::count(backward.begin(), backward.end(), std::int64_t(i)), 0);
      } else {
        EXPECT_EQ(backward[std::size_t(forward[i])], std::int64_t(i));
      }
    }
  }
}

}  // namespace
}  // namespace stereomotion
