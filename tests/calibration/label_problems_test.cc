#include <gtest/gtest.h>

#include <string>

#include "stereomotion/calibration/find_control_points.h"
#include "tests/support/control_scene.h"
#include "tests/support/synthetic_scene.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::ControlScene;
using testing::DrawSeeds;
using testing::MakeControlScene;
using testing::MakeTestRng;
using testing::RenderScene;
using testing::SceneNoise;

Expected<ControlPointView, LabelProblem> Find(const ControlScene& scene, const Image& image,
                                              const std::vector<Seed>& seeds) {
  return FindControlPoints(image.View(), SceneNoise(), scene.target, seeds);
}

TEST(FindControlPoints, ExchangedIdsWithNothingElseToTell) {
  auto rng = MakeTestRng();
  const ControlScene scene = MakeControlScene(7, rng);
  auto seeds = DrawSeeds(scene, 7, rng);
  std::swap(seeds[1].pixel_px, seeds[4].pixel_px);
  const auto view = Find(scene, RenderScene(scene, 1), seeds);
  ASSERT_FALSE(view);
  EXPECT_EQ(view.error().failure, LabelFailure::kMislabelled);
  EXPECT_EQ(view.error().suspects, (std::vector<int>{1, 4}));
}

TEST(FindControlPoints, LeftHandedSurvey) {
  auto rng = MakeTestRng();
  for (int axis = 0; axis < 3; ++axis) {
    ControlScene scene = MakeControlScene(30, rng);
    for (TargetPoint& point : scene.target.points) point.xyz_mm[axis] *= -1;
    const auto view = Find(scene, RenderScene(scene, 1), DrawSeeds(scene, 8, rng));
    ASSERT_FALSE(view);
    EXPECT_EQ(view.error().failure, LabelFailure::kMirrored) << view.error().text;
  }
}

TEST(FindControlPoints, SeedsOfTheOtherCamera) {
  auto rng = MakeTestRng();
  const ControlScene scene = MakeControlScene(30, rng);
  const RigCamera other = testing::MakeConvergingRig().cameras[1];
  std::vector<Seed> seeds;
  for (int i = 0; i < 8; ++i) {
    seeds.push_back({i, *ProjectWorldPoint(other, scene.target.points[i].xyz_mm)});
  }
  const auto view = Find(scene, RenderScene(scene, 1), seeds);
  ASSERT_FALSE(view);
  EXPECT_TRUE(view.error().failure == LabelFailure::kMislabelled ||
              view.error().failure == LabelFailure::kTooFewBalls);
  EXPECT_FALSE(view.error().text.empty());
}

TEST(FindControlPoints, CoplanarPoints) {
  auto rng = MakeTestRng();
  ControlScene scene = MakeControlScene(30, rng);
  for (TargetPoint& point : scene.target.points) point.xyz_mm.z() = 0.2 * point.xyz_mm.x();
  scene = MakeControlScene(scene.target);
  const auto view = Find(scene, RenderScene(scene, 1), DrawSeeds(scene, 8, rng));
  ASSERT_FALSE(view);
  EXPECT_EQ(view.error().failure, LabelFailure::kFlat);
}

TEST(FindControlPoints, TooFewBallsNearTheSeeds) {
  auto rng = MakeTestRng();
  const ControlScene scene = MakeControlScene(12, rng);
  const Image image = RenderScene(scene, 1, {0, 1, 2});
  const auto view = Find(scene, image, DrawSeeds(scene, 8, rng));
  ASSERT_FALSE(view);
  EXPECT_EQ(view.error().failure, LabelFailure::kTooFewBalls);
  EXPECT_EQ(view.error().suspects, (std::vector<int>{0, 1, 2}));
  const auto dark =
      Find(scene, RenderScene({{}, scene.camera, {}, {}}, 1), DrawSeeds(scene, 8, rng));
  ASSERT_FALSE(dark);
  EXPECT_EQ(dark.error().failure, LabelFailure::kTooFewBalls);
}

TEST(FindControlPoints, SeedlessWithoutRods) {
  auto rng = MakeTestRng();
  const ControlScene scene = MakeControlScene(20, rng);
  const auto view = Find(scene, RenderScene(scene, 1), {});
  ASSERT_FALSE(view);
  EXPECT_EQ(view.error().failure, LabelFailure::kNotIdentifiable);
}

TEST(FindControlPoints, SeedlessCrossLooksTheSameTurned) {
  Target target;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double place_mm : {-200, -90, 90, 200}) {
      target.points.push_back(
          {std::to_string(target.points.size()), place_mm * Eigen::Vector3d::Unit(axis), 0});
    }
  }
  const ControlScene scene = MakeControlScene(target);
  const auto view = Find(scene, RenderScene(scene, 1), {});
  ASSERT_FALSE(view);
  EXPECT_EQ(view.error().failure, LabelFailure::kNotIdentifiable);
}

TEST(FindControlPoints, WrongSeedsAreTheCallersMistake) {
  auto rng = MakeTestRng();
  const ControlScene scene = MakeControlScene(8, rng);
  const Image image = RenderScene(scene, 1);
  auto seeds = DrawSeeds(scene, 8, rng);
  seeds[1].point = 0;
  EXPECT_THROW(Find(scene, image, seeds), std::invalid_argument);
  seeds[1].point = 8;
  EXPECT_THROW(Find(scene, image, seeds), std::invalid_argument);
  ControlScene board = scene;
  board.target.type = TargetType::kChessboard;
  EXPECT_THROW(Find(board, image, {}), std::invalid_argument);
}

}  // namespace
}  // namespace stereomotion
