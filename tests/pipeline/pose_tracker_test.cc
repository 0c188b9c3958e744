#include "stereomotion/pipeline/pose_tracker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "stereomotion/geometry/so3.h"
#include "tests/support/synthetic_scene.h"
#include "tests/support/test_rng.h"

namespace stereomotion::testing {
namespace {

class PoseTrackerTest : public ::testing::Test {
 protected:
  static constexpr std::int64_t kFrameNs = 10'000'000;  // 100 pairs a second
  Rig rig_ = MakeConvergingRig();
  Body body_ = MakeTwoRodBody();
  std::mt19937_64 rng_ = MakeTestRng();
  ObserveOptions observe_;

  PoseTracker MakeTracker() const { return {rig_.cameras[0], rig_.cameras[1], body_}; }
  ObservedPair See(const Rigid3& pose) {
    return Observe(rig_.cameras[0], rig_.cameras[1], body_, pose, observe_, rng_);
  }
  /// A swinging, turning body: up to 1 m/s and 3 rad/s.
  static Rigid3 PoseAt(double time_s) {
    return {ExpSO3({0.5 * std::sin(4 * time_s), 0.8 * std::sin(3 * time_s), 0.4 * time_s}),
            {100 * std::sin(9 * time_s), 60 * std::cos(7 * time_s), 80 * std::sin(5 * time_s)}};
  }
  double WorstBallMm(const PoseEstimate& pose, const Rigid3& truth) const {
    double worst_mm = 0;
    for (const Rod& rod : body_.rods) {
      for (const Eigen::Vector3d& p : rod.balls_in_body_mm) {
        worst_mm = std::max(worst_mm, (BodyPlacement(body_, pose) * p - truth * p).norm());
      }
    }
    return worst_mm;
  }
};

TEST_F(PoseTrackerTest, FollowsWithHiddenAndFalseBalls) {
  observe_.hide_probability = 0.2;
  observe_.min_per_rod = 3;
  observe_.false_balls = 24;
  observe_.merge_overlaps = true;
  PoseTracker tracker = MakeTracker();
  int found = 0;
  double worst_mm = 0;
  constexpr int kFrames = 300;
  for (int frame = 0; frame < kFrames; ++frame) {
    const Rigid3 truth = PoseAt(0.01 * frame);
    const ObservedPair pair = See(truth);
    const auto fix = tracker.Track(frame * kFrameNs, pair.left, pair.right);
    if (!fix) continue;
    ++found;
    worst_mm = std::max(worst_mm, WorstBallMm(fix->pose, truth));
  }
  EXPECT_GE(found, kFrames * 99 / 100);
  EXPECT_LT(worst_mm, 0.5);
  RecordProperty("worst_mm", std::to_string(worst_mm));
}

TEST_F(PoseTrackerTest, WithholdsPosesWhileACameraIsBumped) {
  PoseTracker tracker = MakeTracker();
  for (int frame = 0; frame < 30; ++frame) {
    ObservedPair pair = See(PoseAt(0.01 * frame));
    const bool bumped = frame >= 10 && frame < 20;
    for (BallObservation& ball : pair.right) ball.center_px.x() += bumped ? 0.8 : 0.0;
    const auto fix = tracker.Track(frame * kFrameNs, pair.left, pair.right);
    ASSERT_EQ(fix.has_value(), !bumped) << frame;
    if (bumped) {
      EXPECT_EQ(fix.error(), PoseStatus::kInconsistent);
    }
  }
}

TEST_F(PoseTrackerTest, OneCameraAloneIsNotBelievedAgainstTheOther) {
  PoseTracker tracker = MakeTracker();
  for (int frame = 0; frame < 10; ++frame) {
    ObservedPair pair = See(PoseAt(0.01 * frame));
    ASSERT_TRUE(tracker.Track(frame * kFrameNs, pair.left, pair.right));
  }
  ObservedPair shifted = See(PoseAt(0.1));
  for (BallObservation& ball : shifted.right) ball.center_px.x() += 25;
  EXPECT_FALSE(tracker.Track(10 * kFrameNs, shifted.left, shifted.right));
  // With nothing to contradict it, the left camera alone carries the pose on.
  ObservedPair alone = See(PoseAt(0.11));
  const auto fix = tracker.Track(11 * kFrameNs, alone.left, {});
  ASSERT_TRUE(fix);
  EXPECT_EQ(fix->pose.balls_right, 0);
}

TEST(LevelHistogram, MedianToTwoPercent) {
  LevelHistogram levels;
  EXPECT_FALSE(levels.Median());
  for (int i = 1; i <= 1001; ++i) levels.Add(0.01 * i);
  EXPECT_NEAR(*levels.Median(), 5.01, 0.1);
  EXPECT_EQ(levels.count(), 1001);
}

TEST_F(PoseTrackerTest, AcquiresAgainAfterALoss) {
  PoseTracker tracker = MakeTracker();
  for (int frame = 0; frame < 10; ++frame) {
    const ObservedPair pair = See(PoseAt(0.01 * frame));
    ASSERT_TRUE(tracker.Track(frame * kFrameNs, pair.left, pair.right));
  }
  for (int frame = 10; frame < 20; ++frame) {
    const auto fix = tracker.Track(frame * kFrameNs, {}, {});
    ASSERT_FALSE(fix);
    EXPECT_EQ(fix.error(), PoseStatus::kTooFewBalls);
  }
  // Somewhere else altogether.
  const Rigid3 truth{ExpSO3({1.5, -0.4, 0.7}), {-80, 40, 60}};
  const ObservedPair pair = See(truth);
  const auto fix = tracker.Track(20 * kFrameNs, pair.left, pair.right);
  ASSERT_TRUE(fix);
  EXPECT_LT(WorstBallMm(fix->pose, truth), 0.5);
}

TEST_F(PoseTrackerTest, AJumpIsNoTrack) {
  PoseTracker tracker = MakeTracker();
  for (int frame = 0; frame < 40; ++frame) {
    const Rigid3 truth = RandomPose(rng_);  // no motion law at all
    observe_.merge_overlaps = true;
    const ObservedPair pair = See(truth);
    const auto fix = tracker.Track(frame * kFrameNs, pair.left, pair.right);
    EXPECT_LT(fix ? WorstBallMm(fix->pose, truth) : 0.0, 0.5) << frame;
  }
}

TEST_F(PoseTrackerTest, ASlipAlongARodIsNotFollowed) {
  // Moves by exactly one ball from one pair to the next: as fast as that, the next ball stands
  // where the last one was, and only the ends tell.
  body_ = MakeEquallySpacedBody();
  body_.rods[1].balls_in_body_mm[0].y() += 20;
  PoseTracker tracker = MakeTracker();
  for (int frame = 0; frame < 6; ++frame) {
    const Rigid3 truth{Eigen::Quaterniond::Identity(), {-150 + 60.0 * frame, 0, 0}};
    const ObservedPair pair = See(truth);
    const auto fix = tracker.Track(frame * kFrameNs, pair.left, pair.right);
    ASSERT_TRUE(fix) << frame << " " << static_cast<int>(fix.error());
    EXPECT_LT(WorstBallMm(fix->pose, truth), 0.5) << frame;
  }
}

TEST_F(PoseTrackerTest, ContinuityDecidesWhatOnePairCannot) {
  body_ = MakeRodBody({0, 50, 100, 150, 200});
  body_.rods[0].balls_in_body_mm[4] +=
      0.1 * (body_.rods[0].balls_in_body_mm[4] - body_.rods[0].balls_in_body_mm[0]);
  PoseTracker tracker = MakeTracker();
  for (int frame = 0; frame < 8; ++frame) {
    const Rigid3 truth = PoseAt(0.001 * frame);
    ObservedPair pair = See(truth);
    if (frame > 3) {  // the ball that tells is gone
      for (const BallAssignment& a : pair.truth) {
        if (a.id.ball == 4) ObservationOf(pair, a).center_px = {-1e4, -1e4};
      }
    }
    const auto fix = tracker.Track(frame * kFrameNs / 10, pair.left, pair.right);
    ASSERT_TRUE(fix) << frame;
    EXPECT_LT(WorstBallMm(fix->pose, truth), 0.5) << frame;
  }
}

TEST_F(PoseTrackerTest, FreeRollStaysClosestToTheLastPose) {
  body_ = MakeRodBody({0, 40, 95, 165, 250});
  PoseTracker tracker = MakeTracker();
  Rigid3 previous;  // identity at first
  for (int frame = 0; frame < 20; ++frame) {
    const ObservedPair pair = See(PoseAt(0.01 * frame));
    const auto fix = tracker.Track(frame * kFrameNs, pair.left, pair.right);
    ASSERT_TRUE(fix);
    const Eigen::Vector3d turn_rad =
        LogSO3(fix->pose.world_from_body.rotation * previous.rotation.conjugate());
    EXPECT_NEAR(turn_rad.dot(*fix->pose.free_axis_in_world), 0, 1e-9) << frame;
    previous = fix->pose.world_from_body;
  }
}

TEST_F(PoseTrackerTest, TimesMustNotDecrease) {
  PoseTracker tracker = MakeTracker();
  const ObservedPair pair = See(PoseAt(0));
  ASSERT_TRUE(tracker.Track(kFrameNs, pair.left, pair.right));
  EXPECT_TRUE(tracker.Track(kFrameNs, pair.left, pair.right));
  EXPECT_THROW(tracker.Track(0, pair.left, pair.right), std::invalid_argument);
}

TEST_F(PoseTrackerTest, BadOptions) {
  TrackerOptions options;
  options.min_explained = 0;
  EXPECT_THROW(PoseTracker(rig_.cameras[0], rig_.cameras[1], body_, options),
               std::invalid_argument);
}

}  // namespace
}  // namespace stereomotion::testing
