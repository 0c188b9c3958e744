#include "stereomotion/pose/body_confusion.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "stereomotion/geometry/rigid3.h"
#include "stereomotion/geometry/so3.h"
#include "tests/support/test_rng.h"

namespace stereomotion::testing {
namespace {

/// Two rods, 60 mm apart and askew.
Body Cross(const char* name) {
  return {name,
          {{"A", 14, {{-90, 0, 0}, {-60, 0, 0}, {-15, 0, 0}, {35, 0, 0}, {95, 0, 0}}, 0},
           {"B", 14, {{0, -80, 60}, {0, -45, 60}, {0, -20, 60}, {0, 30, 60}, {0, 70, 60}}, 0}}};
}

Body Moved(Body body, const Rigid3& motion) {
  for (Rod& rod : body.rods) {
    for (Eigen::Vector3d& ball_mm : rod.balls_in_body_mm) ball_mm = motion * ball_mm;
  }
  return body;
}

const Rigid3 kSomewhere{ExpSO3({0.4, -1.2, 2.0}), {500, -30, 70}};

TEST(FindConfusion, SameBodyElsewhereWithRodsTurnedAround) {
  Body other = Moved(Cross("b"), kSomewhere);
  std::swap(other.rods[0], other.rods[1]);
  for (Rod& rod : other.rods) {
    std::reverse(rod.balls_in_body_mm.begin(), rod.balls_in_body_mm.end());
  }
  const auto found = FindConfusion(Cross("a"), other);
  ASSERT_TRUE(found);
  EXPECT_LT(found->margin_mm, 1e-9);
  EXPECT_TRUE(found->alike());
  EXPECT_EQ(found->rods, (std::vector<std::pair<int, int>>{{0, 1}, {1, 0}}));
}

/// A rod moved by d along the normal of both: its five balls go by d against the other five, so the
/// best alignment leaves d/2 on each (the tilt that could take some of it back is none: both rods
/// are in planes of one z).
TEST(FindConfusion, MarginIsTheRmsAfterTheBestAlignment) {
  Body other = Cross("b");
  for (Eigen::Vector3d& ball_mm : other.rods[1].balls_in_body_mm) ball_mm.z() += 8;
  const auto found = FindConfusion(Cross("a"), Moved(other, kSomewhere));
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->margin_mm, 4, 0.05);
  EXPECT_FALSE(found->alike());
}

TEST(FindConfusion, MirrorImageIsAnotherBody) {
  Body mirrored = Cross("b");
  for (Rod& rod : mirrored.rods) {
    for (Eigen::Vector3d& ball_mm : rod.balls_in_body_mm) ball_mm.z() = -ball_mm.z();
  }
  EXPECT_FALSE(FindConfusion(Cross("a"), mirrored)->alike());
}

TEST(FindConfusion, SingleRodOnARodOfTheOther) {
  Body rod = Cross("b");
  rod.rods.erase(rod.rods.begin());
  for (const bool turned : {false, true}) {
    const auto found = turned ? FindConfusion(Cross("a"), Moved(rod, kSomewhere))
                              : FindConfusion(Moved(rod, kSomewhere), Cross("a"));
    ASSERT_TRUE(found);
    EXPECT_EQ(found->rods.size(), 1U);
    EXPECT_TRUE(found->alike());
  }
  rod.rods[0].balls_in_body_mm = {{0, 0, 0}, {22, 0, 0}, {68, 0, 0}, {101, 0, 0}, {177, 0, 0}};
  EXPECT_FALSE(FindConfusion(Cross("a"), rod)->alike());
}

TEST(FindConfusion, ShortRodOnPartOfALongOne) {
  Body shorter = Moved(Cross("b"), kSomewhere);
  shorter.rods[0].balls_in_body_mm.erase(shorter.rods[0].balls_in_body_mm.begin() + 1);
  EXPECT_TRUE(FindConfusion(Cross("a"), shorter)->alike());
}

TEST(FindConfusion, BallsOfAnotherSizeAreNeverTaken) {
  Body larger = Cross("b");
  for (Rod& rod : larger.rods) rod.ball_diameter_mm *= 1.7;
  EXPECT_FALSE(FindConfusion(Cross("a"), larger));
}

TEST(FindConfusion, UncertainBodiesNeedMore) {
  Body other = Cross("b");
  for (Eigen::Vector3d& ball_mm : other.rods[1].balls_in_body_mm) ball_mm.z() += 8;
  EXPECT_FALSE(FindConfusion(Cross("a"), other)->alike());
  for (Rod& rod : other.rods) rod.sigma_mm = 1;
  const auto found = FindConfusion(Cross("a"), other);
  EXPECT_TRUE(found->alike());
  EXPECT_GT(found->needed_mm, 5);  // gate_sigma x 1 mm
}

/// Rods that share three of their balls, as they are made from one template.
TEST(FindConfusion, ThreeBallsOfEachRod) {
  Body other = Moved(Cross("b"), kSomewhere);
  const Eigen::Vector3d along_a = kSomewhere.rotation * Eigen::Vector3d::UnitX();
  const Eigen::Vector3d along_b = kSomewhere.rotation * Eigen::Vector3d::UnitY();
  other.rods[0].balls_in_body_mm[4] += 40 * along_a;
  other.rods[0].balls_in_body_mm[3] += 15 * along_a;
  other.rods[1].balls_in_body_mm[0] -= 40 * along_b;
  other.rods[1].balls_in_body_mm[1] -= 15 * along_b;
  EXPECT_FALSE(FindConfusion(Cross("a"), other)->alike());
  EXPECT_TRUE(FindConfusion(Cross("a"), other, {}, 3)->alike());
}

TEST(FindConfusion, RandomRodsAreNotAlike) {
  auto rng = MakeTestRng();
  const auto random_body = [&] {
    Body body = Moved(Cross("r"), kSomewhere);
    std::uniform_real_distribution<double> gap_mm(20, 80);
    for (Rod& rod : body.rods) {
      double place_mm = 0;
      const Eigen::Vector3d start_mm = rod.balls_in_body_mm[0];
      const Eigen::Vector3d along = (rod.balls_in_body_mm[1] - start_mm).normalized();
      for (Eigen::Vector3d& ball_mm : rod.balls_in_body_mm) {
        ball_mm = start_mm + place_mm * along;
        place_mm += gap_mm(rng);
      }
    }
    return body;
  };
  for (int i = 0; i < 20; ++i) EXPECT_FALSE(FindConfusion(random_body(), random_body())->alike());
}

}  // namespace
}  // namespace stereomotion::testing
