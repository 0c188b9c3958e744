#include "pipeline/body_trackers.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "stereomotion/geometry/so3.h"
#include "tests/support/statistics.h"
#include "tests/support/synthetic_scene.h"
#include "tests/support/test_rng.h"

namespace stereomotion::testing {
namespace {

constexpr int kTests = 2;  ///< two-sided ones in this program
constexpr std::int64_t kFrameNs = 10'000'000;
constexpr int kFrames = 80;

Body MakeOtherBody() {
  Body body = MakeTwoRodBody();
  body.name = "other";
  body.rods[0].balls_in_body_mm = {
      {-95, -50, 0}, {-20, -50, 0}, {10, -50, 0}, {48, -50, 0}, {105, -50, 0}};
  body.rods[1].balls_in_body_mm = {
      {-70, 55, 20}, {-48, 55, 20}, {5, 55, 20}, {70, 55, 20}, {96, 55, 20}};
  return body;
}

using Fixes = std::vector<Expected<PoseFix, PoseStatus>>;

/// What both cameras see of several bodies.
struct Sight {
  std::array<std::vector<BallObservation>, 2> balls;
};

/// Adds what is seen of one more body; outlines that touch those of others cannot be measured.
void AddTo(Sight& sight, const ObservedPair& pair) {
  for (std::size_t camera : {0, 1}) {
    auto& all = sight.balls[camera];
    const std::size_t others = all.size();
    for (BallObservation ball : camera == 0 ? pair.left : pair.right) {
      for (std::size_t i = 0; i < others; ++i) {
        const double gap_px = (all[i].center_px - ball.center_px).norm();
        if (gap_px > all[i].semi_major_px + ball.semi_major_px) continue;
        all[i].status = ball.status = BlobStatus::kPartly;
      }
      all.push_back(ball);
    }
  }
}

class BodyTrackersTest : public ::testing::Test {
 protected:
  BodyTrackersTest() {
    setup_.rig = MakeConvergingRig();
    setup_.bodies = {MakeTwoRodBody(), MakeOtherBody()};
  }
  /// Two bodies that pass each other, one 60 mm behind the other, while they turn.
  static Rigid3 PoseAt(std::size_t body, double time_s) {
    const double sign = body == 0 ? 1 : -1;
    return {ExpSO3({0.3 * std::sin(3 * time_s), 0.4 * sign * time_s, 0.8 * sign * time_s}),
            {sign * (400 * time_s - 160), 30 * std::sin(5 * time_s), 30 * sign}};
  }
  static bool IsSeen(std::size_t body, int frame) {
    return body == 0 ? frame < 55 || frame >= 62 : frame < 20 || frame >= 30;
  }
  Sight See(int frame) {
    Sight sight;
    for (std::size_t body = 0; body < setup_.bodies.size(); ++body) {
      if (!IsSeen(body, frame)) continue;
      AddTo(sight, Observe(setup_.rig.cameras[0], setup_.rig.cameras[1], setup_.bodies[body],
                           PoseAt(body, 0.01 * frame), {}, rng_));
    }
    return sight;
  }

  MeasureSetup setup_;
  std::mt19937_64 rng_ = MakeTestRng();
};

void ExpectNoneServesTwo(const Fixes& fixes) {
  std::set<std::pair<int, int>> used;
  for (const auto& fix : fixes) {
    if (!fix) continue;
    for (const BallAssignment& one : fix->used) {
      EXPECT_TRUE(used.insert({one.camera, one.detection}).second);
    }
  }
}

TEST_F(BodyTrackersTest, BodiesThatCrossHideAndReturn) {
  BodyTrackers trackers(setup_, {});
  std::array<ErrorStatistics, 2> errors;
  std::array<int, 2> lost{};
  for (int frame = 0; frame < kFrames; ++frame) {
    const Sight sight = See(frame);
    const Fixes& fixes = trackers.Track(frame * kFrameNs, sight.balls[0], sight.balls[1]);
    ExpectNoneServesTwo(fixes);
    for (std::size_t body : {0, 1}) {
      if (!IsSeen(body, frame)) {
        EXPECT_FALSE(fixes[body]) << body << " in " << frame;  // never on the other's balls
        continue;
      }
      lost[body] += fixes[body] ? 0 : 1;
      if (!fixes[body]) continue;
      errors[body].Add(
          PerturbationBetween(PoseAt(body, 0.01 * frame), fixes[body]->pose.world_from_body),
          fixes[body]->pose.covariance);
    }
  }
  for (std::size_t body : {0, 1}) {
    EXPECT_LE(lost[body], 2) << body;  // where most outlines touch
    EXPECT_TRUE(IsConsistent(errors[body], FamilyZ(kTests))) << errors[body].nees_per_dof();
  }
}

TEST_F(BodyTrackersTest, OrderOfTheBodiesDecidesNothing) {
  MeasureSetup swapped = setup_;
  std::swap(swapped.bodies[0], swapped.bodies[1]);
  BodyTrackers one(setup_, {}), other(swapped, {});
  for (int frame = 0; frame < kFrames; ++frame) {
    const Sight sight = See(frame);
    const Fixes& a = one.Track(frame * kFrameNs, sight.balls[0], sight.balls[1]);
    const Fixes& b = other.Track(frame * kFrameNs, sight.balls[0], sight.balls[1]);
    for (std::size_t body : {0, 1}) {
      ASSERT_EQ(a[body].has_value(), b[1 - body].has_value()) << frame;
      if (!a[body]) {
        EXPECT_EQ(a[body].error(), b[1 - body].error());
        continue;
      }
      EXPECT_EQ(a[body]->pose.world_from_body.translation_mm,
                b[1 - body]->pose.world_from_body.translation_mm);
      EXPECT_EQ(a[body]->pose.covariance, b[1 - body]->pose.covariance);
      EXPECT_EQ(a[body]->used.size(), b[1 - body]->used.size());
    }
  }
}

/// 1 mm tells the bodies apart only while the true one is there to claim its balls.
TEST_F(BodyTrackersTest, BallsGoToTheBodyThatTheyFitBetter) {
  setup_.bodies[1] = setup_.bodies[0];
  for (Eigen::Vector3d& ball_mm : setup_.bodies[1].rods[1].balls_in_body_mm) ball_mm.y() += 1;
  for (const std::size_t there : {0, 1}) {
    BodyTrackers trackers(setup_, {});
    for (int frame = 0; frame < 10; ++frame) {
      const ObservedPair pair = Observe(setup_.rig.cameras[0], setup_.rig.cameras[1],
                                        setup_.bodies[there], PoseAt(0, 0.01 * frame), {}, rng_);
      const Fixes& fixes = trackers.Track(frame * kFrameNs, pair.left, pair.right);
      EXPECT_TRUE(fixes[there]) << there << " in " << frame;
      EXPECT_FALSE(fixes[1 - there]) << there << " in " << frame;
    }
  }
}

TEST_F(BodyTrackersTest, OneBodyIsAsWithOneTracker) {
  setup_.bodies.pop_back();
  BodyTrackers trackers(setup_, {});
  PoseTracker tracker(setup_.rig.cameras[0], setup_.rig.cameras[1], setup_.bodies[0]);
  for (int frame = 0; frame < kFrames; ++frame) {
    const Sight sight = See(frame);
    const auto& fix = trackers.Track(frame * kFrameNs, sight.balls[0], sight.balls[1])[0];
    const auto expected = tracker.Track(frame * kFrameNs, sight.balls[0], sight.balls[1]);
    ASSERT_EQ(fix.has_value(), expected.has_value());
    if (!fix) continue;
    EXPECT_EQ(fix->pose.covariance, expected->pose.covariance);
  }
}

}  // namespace
}  // namespace stereomotion::testing
