#include "stereomotion/calibration/refine_rig.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/bumped_scene.h"
#include "tests/support/calibration_scene.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::BumpedScene;
using testing::MakeBumpedScene;

constexpr double kChi2Of6At999 = 22.458;

bool Says(const RefinedRig& refined, const std::string& name) {
  return std::any_of(refined.warnings.begin(), refined.warnings.end(),
                     [&](const auto& note) { return note.name == name; });
}

BumpedScene MakeScene(const Body& body, int frames = 12) {
  return MakeBumpedScene(testing::MakeConvergingRig(), body, frames);
}

Rig Bumped(const BumpedScene& scene, double turn_deg, std::mt19937_64& rng) {
  Rig rig = scene.truth;
  testing::Bump(turn_deg, 20, rng, rig);
  return rig;
}

// χ² of all that was estimated against the truth.
double Nees(const RefinedRig& refined, const Rig& truth) {
  const Eigen::VectorXd error = testing::RigError(refined.rig, truth);
  return error.dot(refined.rig.covariance->matrix.ldlt().solve(error));
}

// Exact observations of an exact rig: whatever the second camera's start, the true pose comes back.
TEST(RefineRig, ExactImagesGiveTheTrueRig) {
  auto rng = testing::MakeTestRng();
  BumpedScene scene = MakeScene(testing::MakeTwoRodBody());
  scene.observe.noise_scale = 0;
  for (const double bump_deg : {0.0, 0.5, 3.0, 20.0}) {
    const auto refined =
        RefineRig(Bumped(scene, bump_deg, rng), scene.body, testing::See(scene, rng));
    ASSERT_TRUE(refined) << refined.error().text;
    const Vector6d error = PerturbationBetween(scene.truth.cameras[1].cam_from_world,
                                               refined->rig.cameras[1].cam_from_world);
    EXPECT_LT(error.head<3>().norm(), 1e-9);
    EXPECT_LT(error.tail<3>().norm(), 1e-5);
    EXPECT_EQ(refined->frames.size(), 12U);
    EXPECT_TRUE(refined->motion.significant);
    EXPECT_NEAR(refined->motion.change.head<3>().norm(), bump_deg * M_PI / 180, 1e-6);
    EXPECT_TRUE(Says(*refined, "no_old_covariance"));
    EXPECT_TRUE(Says(*refined, "scale_from_exact_body"));
  }
}

// Two rods of the same equal spacing: cross-ratios tell neither which rod nor which way round.
TEST(RefineRig, RodsThatLookAlikeAreToldApartOverFrames) {
  auto rng = testing::MakeTestRng();
  const BumpedScene scene = MakeScene(testing::MakeEquallySpacedBody());
  const auto refined = RefineRig(Bumped(scene, 3, rng), scene.body, testing::See(scene, rng));
  ASSERT_TRUE(refined) << refined.error().text;
  EXPECT_EQ(refined->frames.size(), 12U);
  EXPECT_LT(Nees(*refined, scene.truth), kChi2Of6At999);
}

TEST(RefineRig, RodsOfThreeBalls) {
  auto rng = testing::MakeTestRng();
  Body body = testing::MakeTwoRodBody();
  for (Rod& rod : body.rods) {
    rod.balls_in_body_mm.erase(rod.balls_in_body_mm.begin() + 1);
    rod.balls_in_body_mm.erase(rod.balls_in_body_mm.begin() + 2);
  }
  const BumpedScene scene = MakeScene(body, 20);
  const auto refined = RefineRig(Bumped(scene, 2, rng), body, testing::See(scene, rng));
  ASSERT_TRUE(refined) << refined.error().text;
  EXPECT_GE(refined->frames.size(), 15U);
  EXPECT_LT(Nees(*refined, scene.truth), kChi2Of6At999);
}

TEST(RefineRig, FalseAndHiddenBalls) {
  auto rng = testing::MakeTestRng();
  BumpedScene scene = MakeScene(testing::MakeTwoRodBody(), 60);
  scene.observe.false_balls = 8;
  scene.observe.hide_probability = 0.03;
  const auto refined = RefineRig(Bumped(scene, 2, rng), scene.body, testing::See(scene, rng));
  ASSERT_TRUE(refined) << refined.error().text;
  // 0.97²⁰ = 54 % of the frames show everything.
  EXPECT_GE(refined->frames.size(), 20U);
  EXPECT_LT(Nees(*refined, scene.truth), kChi2Of6At999);
  EXPECT_LT(refined->balls_rejected, refined->balls_used / 20);
}

TEST(RefineRig, NoMoreFramesThanAsked) {
  auto rng = testing::MakeTestRng();
  const BumpedScene scene = MakeScene(testing::MakeTwoRodBody(), 100);
  const auto frames = testing::See(scene, rng);
  const Rig old_rig = Bumped(scene, 1, rng);
  const auto refined = RefineRig(old_rig, scene.body, frames, {6});
  ASSERT_TRUE(refined);
  EXPECT_EQ(refined->frames.size(), 6U);
  EXPECT_TRUE(std::is_sorted(refined->frames.begin(), refined->frames.end()));
  const auto again = RefineRig(old_rig, scene.body, frames, {6});
  EXPECT_EQ(again->rig.covariance->matrix, refined->rig.covariance->matrix);
  EXPECT_EQ(again->frames, refined->frames);
}

// A long run in which the body turns: even steps would meet it always in the same place.
TEST(RefineRig, PeriodicMotion) {
  auto rng = testing::MakeTestRng();
  const BumpedScene scene = MakeScene(testing::MakeTwoRodBody(), 16);
  const auto turn = testing::See(scene, rng);
  std::vector<RefineFrame> frames;
  for (int f = 0; f < 1600; ++f) {
    frames.push_back(turn[f % 16]);
    frames.back().frame = f;
  }
  const auto refined = RefineRig(Bumped(scene, 2, rng), scene.body, frames, {10});
  ASSERT_TRUE(refined) << refined.error().text;
  EXPECT_EQ(refined->frames.size(), 10U);
  EXPECT_LT(Nees(*refined, scene.truth), kChi2Of6At999);
}

// The rods see the cameras against each other only: the world goes with the first.
TEST(RefineRig, FirstCameraBumpedMovesTheWorld) {
  auto rng = testing::MakeTestRng();
  BumpedScene scene = MakeScene(testing::MakeTwoRodBody());
  scene.observe.noise_scale = 0;
  Rig old_rig = scene.truth;
  std::swap(old_rig.cameras[0], old_rig.cameras[1]);
  testing::Bump(2, 20, rng, old_rig);
  std::swap(old_rig.cameras[0], old_rig.cameras[1]);
  const auto refined = RefineRig(old_rig, scene.body, testing::See(scene, rng));
  ASSERT_TRUE(refined);
  const auto first_from_second = [](const Rig& rig) {
    return rig.cameras[0].cam_from_world * rig.cameras[1].cam_from_world.Inverse();
  };
  const Vector6d error =
      PerturbationBetween(first_from_second(scene.truth), first_from_second(refined->rig));
  EXPECT_LT(error.norm(), 1e-5);
  const Vector6d moved = PerturbationBetween(old_rig.cameras[0].cam_from_world,
                                             refined->rig.cameras[0].cam_from_world);
  EXPECT_EQ(moved.norm(), 0);
}

// fx = fy of the old calibration: its covariance is singular, and the tie is kept.
TEST(RefineRig, TiedFocalLengthsStayTied) {
  auto rng = testing::MakeTestRng();
  Rig truth = testing::MakeConvergingRig();
  truth.covariance = RigCovariance{{{0, 0}, {0, 1}, {1, 0}, {1, 1}}, Eigen::MatrixXd::Zero(4, 4)};
  truth.covariance->matrix.topLeftCorner<2, 2>().setConstant(0.25);
  truth.covariance->matrix.bottomRightCorner<2, 2>().setConstant(0.16);
  const BumpedScene scene = MakeBumpedScene(truth, testing::MakeTwoRodBody(), 12);
  Rig old_rig = testing::DrawRig(truth, rng);
  testing::Bump(2, 20, rng, old_rig);
  const auto refined = RefineRig(old_rig, scene.body, testing::See(scene, rng));
  ASSERT_TRUE(refined) << refined.error().text;
  for (int c = 0; c < 2; ++c) {
    const CameraModel& after = refined->rig.cameras[c].model;
    const CameraModel& before = old_rig.cameras[c].model;
    EXPECT_NEAR(after.fx_px - before.fx_px, after.fy_px - before.fy_px, 1e-9);
    EXPECT_NE(after.fx_px, before.fx_px);
  }
  EXPECT_EQ(refined->rig.covariance->parameters.size(), 10U);
}

}  // namespace
}  // namespace stereomotion
