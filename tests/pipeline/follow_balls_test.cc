#include "pipeline/follow_balls.h"

#include <gtest/gtest.h>

namespace stereomotion::testing {
namespace {

constexpr std::int64_t kFrameNs = 10'000'000;
constexpr int kWidth = 640, kHeight = 512;

BallObservation BallAt(double u, double v) {
  BallObservation ball;
  ball.center_px = {u, v};
  ball.semi_major_px = ball.semi_minor_px = 4.5;
  return ball;
}

bool Holds(const SearchWindow& window, double u, double v) {
  return window.u_min <= u && u <= window.u_max && window.v_min <= v && v <= window.v_max;
}

/// Two balls, one of which moves by (20, −5) px an image.
BallFollower FollowedTwice() {
  BallFollower follower;
  follower.Update(0, {BallAt(100, 200), BallAt(400, 300)});
  follower.Update(kFrameNs, {BallAt(120, 195), BallAt(400, 300)});
  return follower;
}

TEST(BallFollower, NeedsTwoImages) {
  BallFollower follower;
  EXPECT_FALSE(follower.Predict(0, kWidth, kHeight));
  follower.Update(0, {BallAt(100, 200)});
  EXPECT_FALSE(follower.Predict(kFrameNs, kWidth, kHeight));
}

TEST(BallFollower, GoesOnAtConstantVelocity) {
  BallFollower follower = FollowedTwice();
  ASSERT_TRUE(follower.Predict(2 * kFrameNs, kWidth, kHeight));
  ASSERT_EQ(follower.windows().size(), 2U);
  const SearchWindow& moving = follower.windows()[0];
  EXPECT_EQ(moving.expected.center_px, Eigen::Vector2d(140, 190));
  // The outline, and half a step more or less.
  EXPECT_TRUE(Holds(moving, 140 + 10 + 4.5, 190) && Holds(moving, 140 - 10 - 4.5, 190));
  const SearchWindow& resting = follower.windows()[1];
  EXPECT_EQ(resting.expected.center_px, Eigen::Vector2d(400, 300));
  EXPECT_LT(resting.u_max - resting.u_min, moving.u_max - moving.u_min);
  // Another gap, another step.
  ASSERT_TRUE(follower.Predict(kFrameNs + kFrameNs / 2, kWidth, kHeight));
  EXPECT_EQ(follower.windows()[0].expected.center_px, Eigen::Vector2d(130, 192.5));
}

TEST(BallFollower, LongGap) {
  BallFollower follower = FollowedTwice();
  EXPECT_TRUE(follower.Predict(4 * kFrameNs, kWidth, kHeight));
  EXPECT_FALSE(follower.Predict(6 * kFrameNs, kWidth, kHeight));
  EXPECT_FALSE(follower.Predict(kFrameNs, kWidth, kHeight));  // no time has passed
}

TEST(BallFollower, LostBall) {
  BallFollower follower = FollowedTwice();
  ASSERT_TRUE(follower.Predict(2 * kFrameNs, kWidth, kHeight));
  EXPECT_TRUE(follower.FindsAll({BallAt(141, 189), BallAt(400, 301)}));
  EXPECT_FALSE(follower.FindsAll({BallAt(141, 189)}));
  EXPECT_FALSE(follower.FindsAll({BallAt(141, 189), BallAt(440, 300)}));
}

/// Two balls that merge into one blob: one of them is lost.
TEST(BallFollower, OneBlobForTwoBalls) {
  BallFollower follower;
  follower.Update(0, {BallAt(200, 200), BallAt(224, 200)});
  follower.Update(kFrameNs, {BallAt(204, 200), BallAt(220, 200)});
  ASSERT_TRUE(follower.Predict(2 * kFrameNs, kWidth, kHeight));
  EXPECT_FALSE(follower.FindsAll({BallAt(212, 200)}));
}

TEST(BallFollower, BallThatHasLeftIsNotLost) {
  BallFollower follower;
  follower.Update(0, {BallAt(600, 200), BallAt(300, 300)});
  follower.Update(kFrameNs, {BallAt(630, 200), BallAt(300, 300)});
  ASSERT_TRUE(follower.Predict(3 * kFrameNs, kWidth, kHeight));
  EXPECT_EQ(follower.windows().size(), 1U);
  EXPECT_TRUE(follower.FindsAll({BallAt(300, 300)}));
}

TEST(BallFollower, WindowsEndAtTheBorder) {
  BallFollower follower;
  follower.Update(0, {BallAt(2, 2), BallAt(638, 510)});
  follower.Update(kFrameNs, {BallAt(2, 2), BallAt(638, 510)});
  ASSERT_TRUE(follower.Predict(2 * kFrameNs, kWidth, kHeight));
  EXPECT_EQ(follower.windows()[0].u_min, 0);
  EXPECT_EQ(follower.windows()[0].v_min, 0);
  EXPECT_EQ(follower.windows()[1].u_max, kWidth - 1);
  EXPECT_EQ(follower.windows()[1].v_max, kHeight - 1);
}

TEST(BallFollower, NewBallMayBeAsFastAsTheFastest) {
  BallFollower follower = FollowedTwice();
  follower.Update(2 * kFrameNs, {BallAt(140, 190), BallAt(400, 300), BallAt(500, 100)});
  ASSERT_TRUE(follower.Predict(3 * kFrameNs, kWidth, kHeight));
  ASSERT_EQ(follower.windows().size(), 3U);
  EXPECT_TRUE(Holds(follower.windows()[2], 500 + 20, 100 - 5));
}

}  // namespace
}  // namespace stereomotion::testing
