#include "stereomotion/pose/acquire_pose.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "stereomotion/geometry/so3.h"
#include "tests/support/synthetic_scene.h"
#include "tests/support/test_rng.h"

namespace stereomotion::testing {
namespace {

class AcquirePoseTest : public ::testing::Test {
 protected:
  Rig rig_ = MakeConvergingRig();
  Body body_ = MakeTwoRodBody();
  std::mt19937_64 rng_ = MakeTestRng();
  Rigid3 truth_{ExpSO3({0.2, -0.3, 0.1}), {10, -20, 30}};
  ObserveOptions observe_;

  ObservedPair See(const Rigid3& pose) {
    return Observe(rig_.cameras[0], rig_.cameras[1], body_, pose, observe_, rng_);
  }
  Expected<PoseFix, PoseStatus> Acquire(const ObservedPair& pair, const Rigid3& previous = {}) {
    return AcquirePose(rig_.cameras[0], rig_.cameras[1], body_, pair.left, pair.right, previous);
  }
  /// The largest distance of a ball from where it is.
  double WorstBallMm(const PoseEstimate& pose, const Rigid3& truth) const {
    double worst_mm = 0;
    for (const Rod& rod : body_.rods) {
      for (const Eigen::Vector3d& p : rod.balls_in_body_mm) {
        worst_mm = std::max(worst_mm, (BodyPlacement(body_, pose) * p - truth * p).norm());
      }
    }
    return worst_mm;
  }
  /// Takes balls out of one or both lists by identity.
  template <class Hide>
  static void Remove(ObservedPair& pair, Hide hide) {
    for (const BallAssignment& assignment : pair.truth) {
      // Out of the image, out of everything: keeps the other indices.
      if (hide(assignment))
        ObservationOf(pair, assignment).center_px = {-1e4 - 50 * assignment.id.ball, -1e4};
    }
  }
  /// True where every rod shows ≥ 3 of the same balls to both cameras.
  bool EveryRodShowsThree(const ObservedPair& pair) const {
    std::vector<std::set<int>> left(body_.rods.size()), both(body_.rods.size());
    for (const BallAssignment& a : pair.truth) {
      if (a.camera == 0) left[static_cast<std::size_t>(a.id.rod)].insert(a.id.ball);
    }
    for (const BallAssignment& a : pair.truth) {
      const auto rod = static_cast<std::size_t>(a.id.rod);
      if (a.camera == 1 && left[rod].count(a.id.ball)) both[rod].insert(a.id.ball);
    }
    return std::all_of(both.begin(), both.end(), [](const auto& b) { return b.size() >= 3; });
  }
  void ExpectFailure(const ObservedPair& pair, PoseStatus reason) {
    const auto fix = Acquire(pair);
    ASSERT_FALSE(fix);
    EXPECT_EQ(fix.error(), reason);
  }
};

TEST_F(AcquirePoseTest, ExactObservations) {
  observe_.noise_scale = 0;
  const auto fix = Acquire(See(truth_));
  ASSERT_TRUE(fix);
  EXPECT_LT(WorstBallMm(fix->pose, truth_), 1e-5);
  EXPECT_EQ(fix->used.size(), 20U);
}

TEST_F(AcquirePoseTest, HiddenAndFalseBallsNeverGiveAWrongPose) {
  observe_.hide_probability = 0.25;
  observe_.false_balls = 24;
  observe_.merge_overlaps = true;
  int should = 0, found = 0;
  double worst_mm = 0;
  for (int frame = 0; frame < 400; ++frame) {
    observe_.min_per_rod = frame % 2 == 0 ? 3 : 0;
    const Rigid3 truth = RandomPose(rng_);
    const ObservedPair pair = See(truth);
    const auto fix = Acquire(pair);
    if (fix) worst_mm = std::max(worst_mm, WorstBallMm(fix->pose, truth));
    if (!EveryRodShowsThree(pair)) continue;
    ++should;
    found += fix.has_value();
  }
  EXPECT_LT(worst_mm, 0.5);
  EXPECT_GE(should, 200);
  EXPECT_GE(found, 0.99 * should) << found << " of " << should;
  RecordProperty("found", std::to_string(found) + " of " + std::to_string(should));
}

TEST_F(AcquirePoseTest, OrderOfDetectionsDoesNotMatter) {
  observe_.false_balls = 10;
  ObservedPair pair = See(truth_);
  const auto fix = Acquire(pair);
  std::reverse(pair.left.begin(), pair.left.end());
  const auto again = Acquire(pair);
  ASSERT_TRUE(fix && again);
  EXPECT_LT(PerturbationBetween(fix->pose.world_from_body, again->pose.world_from_body).norm(),
            1e-6);
}

TEST_F(AcquirePoseTest, LeftRightSymmetry) {
  ObservedPair pair = See(truth_);
  const auto fix = Acquire(pair);
  std::swap(pair.left, pair.right);
  std::swap(rig_.cameras[0], rig_.cameras[1]);
  const auto mirrored = Acquire(pair);
  ASSERT_TRUE(fix && mirrored);
  EXPECT_LT(PerturbationBetween(fix->pose.world_from_body, mirrored->pose.world_from_body).norm(),
            1e-6);
}

TEST_F(AcquirePoseTest, SingleRod) {
  body_ = MakeRodBody({0, 40, 95, 165, 250});
  observe_.hide_probability = 0.2;
  observe_.min_per_rod = 3;
  observe_.false_balls = 12;
  int found = 0;
  double worst_mm = 0;
  for (int frame = 0; frame < 200; ++frame) {
    const Rigid3 truth = RandomPose(rng_);
    const auto fix = Acquire(See(truth), truth);
    if (!fix) continue;
    ++found;
    worst_mm = std::max(worst_mm, WorstBallMm(fix->pose, truth));
    EXPECT_TRUE(fix->pose.free_axis_in_world);
    // The roll closest to `previous`, which is the truth: only noise turns it away.
    EXPECT_LT(fix->pose.world_from_body.rotation.angularDistance(truth.rotation), 0.01);
  }
  EXPECT_LT(worst_mm, 0.5);
  EXPECT_GE(found, 180);
  RecordProperty("worst_mm", std::to_string(worst_mm));
  RecordProperty("found", found);
}

TEST_F(AcquirePoseTest, RodsOfThreeAndNineBalls) {
  body_.rods[0].balls_in_body_mm.resize(3);
  Rod& rod = body_.rods[1];
  const Eigen::Vector3d start_mm = rod.balls_in_body_mm.front();
  const Eigen::Vector3d axis = (rod.balls_in_body_mm.back() - start_mm).normalized();
  rod.balls_in_body_mm.clear();
  for (const double place_mm : {0., 40., 85., 135., 170., 230., 275., 310., 380.}) {
    rod.balls_in_body_mm.emplace_back(start_mm + place_mm * axis);
  }
  observe_.false_balls = 10;
  const auto fix = Acquire(See(truth_));
  ASSERT_TRUE(fix);
  EXPECT_LT(WorstBallMm(fix->pose, truth_), 0.2);
}

TEST_F(AcquirePoseTest, EqualSpacingWithAllBallsSeen) {
  body_ = MakeEquallySpacedBody();
  body_.rods[1].balls_in_body_mm[4].x() += 25;  // one rod tells the direction
  const auto fix = Acquire(See(truth_));
  ASSERT_TRUE(fix);
  EXPECT_LT(WorstBallMm(fix->pose, truth_), 0.5);
}

TEST_F(AcquirePoseTest, AmbiguousWhereTheBodyCouldHaveSlipped) {
  body_ = MakeEquallySpacedBody();
  body_.rods[1].balls_in_body_mm[0].y() += 20;  // no turn by 180° fits
  ObservedPair pair = See(truth_);
  // Both rods' last balls are hidden, and the one that tells: a shift by a ball fits as well.
  Remove(pair, [](const auto& a) { return a.id.ball == 4 || (a.id.rod == 1 && a.id.ball == 0); });
  ExpectFailure(pair, PoseStatus::kAmbiguous);
}

TEST_F(AcquirePoseTest, AmbiguousSymmetricBody) {
  body_ = MakeRodBody({0, 50, 100, 150, 200});
  ExpectFailure(See(truth_), PoseStatus::kAmbiguous);
}

TEST_F(AcquirePoseTest, RollUndetermined) {
  ObservedPair pair = See(truth_);
  Remove(pair, [](const auto& a) { return a.id.rod == 1; });
  ExpectFailure(pair, PoseStatus::kRollUndetermined);
}

TEST_F(AcquirePoseTest, TooFewBalls) {
  ExpectFailure({}, PoseStatus::kTooFewBalls);
  ObservedPair pair = See(truth_);
  Remove(pair, [](const auto& a) { return a.id.ball != 1; });
  ExpectFailure(pair, PoseStatus::kTooFewBalls);
}

TEST_F(AcquirePoseTest, LostAmongOtherBalls) {
  const Body seen = body_;
  ObservedPair pair = See(truth_);
  for (Rod& rod : body_.rods) {
    for (Eigen::Vector3d& p : rod.balls_in_body_mm) p = 1.3 * p;
  }
  ExpectFailure(pair, PoseStatus::kLost);
}

TEST_F(AcquirePoseTest, OnlyFalseBallsAreNoBody) {
  observe_.hide_probability = 1;
  observe_.false_balls = 34;
  for (int frame = 0; frame < 100; ++frame) EXPECT_FALSE(Acquire(See(truth_)));
}

}  // namespace
}  // namespace stereomotion::testing
