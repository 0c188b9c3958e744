// What a refinement warns of, and why it gives none.
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "stereomotion/calibration/refine_rig.h"
#include "tests/support/bumped_scene.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::BumpedScene;
using testing::MakeBumpedScene;

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

TEST(RefineRig, LensThatWasTouchedIsTold) {
  auto rng = testing::MakeTestRng();
  const Rig calibrated = testing::MakeCalibratedRig();
  Rig truth = calibrated;
  truth.cameras[1].model.fx_px *= 1.02;
  truth.cameras[1].model.fy_px *= 1.02;
  const BumpedScene scene = MakeBumpedScene(truth, testing::MakeTwoRodBody(), 20);
  const auto refined = RefineRig(calibrated, scene.body, testing::See(scene, rng));
  ASSERT_TRUE(refined) << refined.error().text;
  EXPECT_TRUE(Says(*refined, "lenses_changed"));
}

TEST(RefineRig, WrongBodyIsTold) {
  auto rng = testing::MakeTestRng();
  const BumpedScene scene = MakeScene(testing::MakeTwoRodBody());
  Body file = scene.body;
  file.rods[0].balls_in_body_mm[2].x() += 0.5;
  const auto refined = RefineRig(Bumped(scene, 1, rng), file, testing::See(scene, rng));
  ASSERT_TRUE(refined) << refined.error().text;
  EXPECT_TRUE(Says(*refined, "residuals_too_large") || Says(*refined, "many_rejected"));
}

TEST(RefineRig, LittleMotionIsTold) {
  auto rng = testing::MakeTestRng();
  BumpedScene scene = MakeScene(testing::MakeTwoRodBody(), 8);
  for (auto& pose : scene.world_from_body) {
    pose = {Eigen::Quaterniond::Identity(), {0.1 * testing::Normal(rng), 0, 0}};
  }
  const auto refined = RefineRig(Bumped(scene, 1, rng), scene.body, testing::See(scene, rng));
  if (refined) {
    EXPECT_TRUE(Says(*refined, "little_coverage"));
  } else {
    EXPECT_EQ(refined.error().name, "no_relative_orientation");
  }
}

TEST(RefineRig, NoRods) {
  auto rng = testing::MakeTestRng();
  const BumpedScene scene = MakeScene(testing::MakeTwoRodBody());
  const auto refined = RefineRig(scene.truth, testing::MakeRodBody({0, 20, 200, 230, 260, 400}),
                                 testing::See(scene, rng));
  ASSERT_FALSE(refined);
  EXPECT_EQ(refined.error().name, "no_rods");
}

TEST(RefineRig, TooFewFrames) {
  auto rng = testing::MakeTestRng();
  const BumpedScene scene = MakeScene(testing::MakeTwoRodBody(), 2);
  const auto refined = RefineRig(scene.truth, scene.body, testing::See(scene, rng));
  ASSERT_FALSE(refined);
  EXPECT_EQ(refined.error().name, "too_few_frames");
}

// The right images are of other times.
TEST(RefineRig, NoRelativeOrientation) {
  auto rng = testing::MakeTestRng();
  const BumpedScene scene = MakeScene(testing::MakeTwoRodBody(), 20);
  auto frames = testing::See(scene, rng);
  for (std::size_t f = 0; f + 1 < frames.size(); ++f) {
    std::swap(frames[f].balls[1], frames[f + 1].balls[1]);
  }
  const auto refined = RefineRig(scene.truth, scene.body, frames);
  ASSERT_FALSE(refined);
  EXPECT_EQ(refined.error().name, "no_relative_orientation");
}

TEST(RefineRig, CallersMistakesThrow) {
  Rig rig = testing::MakeConvergingRig();
  const Body body = testing::MakeTwoRodBody();
  EXPECT_THROW(RefineRig(rig, testing::MakeRodBody({0, 100}), {}), std::invalid_argument);
  EXPECT_THROW(RefineRig(rig, body, {}, {2}), std::invalid_argument);
  rig.covariance = RigCovariance{{{0, 0}, {0, 1}}, (Eigen::Matrix2d() << 1, 2, 2, 1).finished()};
  EXPECT_THROW(RefineRig(rig, body, {}), std::invalid_argument);
  rig.cameras.pop_back();
  EXPECT_THROW(RefineRig(rig, body, {}), std::invalid_argument);
}

}  // namespace
}  // namespace stereomotion
