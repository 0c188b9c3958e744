#include "stereomotion/calibration/find_control_points.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/control_scene.h"
#include "tests/support/statistics.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::ControlScene;
using testing::DrawSeeds;
using testing::MakeControlScene;
using testing::MakeTestRng;
using testing::RenderScene;
using testing::SceneNoise;
using testing::Uniform;

Expected<ControlPointView, LabelProblem> Find(const ControlScene& scene, const Image& image,
                                              const std::vector<Seed>& seeds) {
  return FindControlPoints(image.View(), SceneNoise(), scene.target, seeds);
}

/// Counts the balls that bear the right label, to within a pixel.
int CountRight(const ControlScene& scene, const ControlPointView& view) {
  return static_cast<int>(
      std::count_if(view.balls.begin(), view.balls.end(), [&](const LabelledBall& ball) {
        return (ball.ball.center_px - scene.outlines_px[ball.point]).norm() < 1;
      }));
}

TEST(FindControlPoints, AllBallsFromRoughSeeds) {
  auto rng = MakeTestRng();
  testing::ErrorStatistics errors;
  constexpr int kDraws = 8;
  for (int draw = 0; draw < kDraws; ++draw) {
    const ControlScene scene = MakeControlScene(30, rng);
    const Image image = RenderScene(scene, static_cast<std::uint64_t>(draw));
    const auto view = Find(scene, image, DrawSeeds(scene, draw % 2 == 0 ? 6 : 8, rng));
    ASSERT_TRUE(view) << view.error().text;
    EXPECT_EQ(CountRight(scene, *view), 30);
    EXPECT_TRUE(view->contradicting_seeds.empty());
    for (const LabelledBall& ball : view->balls) {
      errors.Add(ball.ball.center_px - scene.outlines_px[ball.point], ball.ball.covariance_px2);
    }
  }
  EXPECT_TRUE(IsConsistent(errors, testing::FamilyZ(1)));
}

TEST(FindControlPoints, DltPredictsTheBalls) {
  auto rng = MakeTestRng();
  const ControlScene scene = MakeControlScene(30, rng);
  const auto view = Find(scene, RenderScene(scene, 1), DrawSeeds(scene, 8, rng));
  ASSERT_TRUE(view);
  for (const LabelledBall& ball : view->balls) {
    const Eigen::Vector2d pixel_px =
        (view->dlt * scene.target.points[ball.point].xyz_mm.homogeneous()).hnormalized();
    // The rig's distortion, which a DLT has not, is a few pixels in the corners.
    EXPECT_LT((pixel_px - ball.ball.center_px).norm(), 10);
  }
}

TEST(FindControlPoints, OneWrongSeedOfEight) {
  auto rng = MakeTestRng();
  for (int draw = 0; draw < 6; ++draw) {
    const ControlScene scene = MakeControlScene(30, rng);
    auto seeds = DrawSeeds(scene, 8, rng);
    // At another ball: the worst place for it.
    seeds[2].pixel_px = scene.outlines_px[20];
    const auto view = Find(scene, RenderScene(scene, static_cast<std::uint64_t>(draw)), seeds);
    ASSERT_TRUE(view) << view.error().text;
    EXPECT_EQ(CountRight(scene, *view), 30);
    EXPECT_EQ(view->contradicting_seeds, std::vector<int>{2});
  }
}

TEST(FindControlPoints, MissingAndFalseBalls) {
  auto rng = MakeTestRng();
  for (int draw = 0; draw < 6; ++draw) {
    const ControlScene scene = MakeControlScene(30, rng);
    const std::vector<int> hidden = {3, 10, 15, 20, 29};
    std::vector<Eigen::Vector2d> false_px;
    while (false_px.size() < 20) {
      const Eigen::Vector2d place(Uniform(rng, 30, 1250), Uniform(rng, 30, 990));
      const bool clear = std::all_of(scene.outlines_px.begin(), scene.outlines_px.end(),
                                     [&](const auto& ball) { return (ball - place).norm() > 20; });
      if (clear) false_px.push_back(place);
    }
    const Image image = RenderScene(scene, static_cast<std::uint64_t>(draw), hidden, false_px);
    const auto view = Find(scene, image, DrawSeeds(scene, 8, rng));
    ASSERT_TRUE(view) << view.error().text;
    EXPECT_EQ(CountRight(scene, *view), 25);
    EXPECT_EQ(view->balls.size(), 25U);
  }
}

TEST(FindControlPoints, ExchangedIdsAreNamed) {
  auto rng = MakeTestRng();
  const ControlScene scene = MakeControlScene(30, rng);
  auto seeds = DrawSeeds(scene, 8, rng);
  std::swap(seeds[1].pixel_px, seeds[4].pixel_px);
  const auto view = Find(scene, RenderScene(scene, 1), seeds);
  ASSERT_TRUE(view) << view.error().text;
  EXPECT_EQ(view->contradicting_seeds, (std::vector<int>{1, 4}));
  EXPECT_EQ(CountRight(scene, *view), 30);
}

/// Three rods of five, uneven and different, no two of them parallel.
Target ThreeRods(bool alike) {
  const std::vector<std::vector<double>> places = {
      {0, 60, 150, 290, 400}, {0, 110, 170, 300, 420}, {0, 50, 210, 260, 380}};
  const std::vector<Eigen::Vector3d> starts = {{-250, -200, 50}, {150, -220, -150}, {-200, 150, 0}};
  const std::vector<Eigen::Vector3d> along = {{0.5, 0.8, 0.35}, {0.1, 0.9, 0.5}, {0.9, 0.1, -0.4}};
  Target target;
  for (int rod = 0; rod < 3; ++rod) {
    for (const double place : places[alike ? 0 : rod]) {
      target.points.push_back(
          {std::to_string(target.points.size()), starts[rod] + place * along[rod].normalized(), 0});
    }
  }
  return target;
}

TEST(FindControlPoints, SeedlessFrameOfThreeRods) {
  for (const bool alike : {false, true}) {
    const ControlScene scene = MakeControlScene(ThreeRods(alike));
    const auto view =
        Find(scene, RenderScene(scene, 1, {}, {{100, 100}, {900, 80}, {300, 800}}), {});
    ASSERT_TRUE(view) << view.error().text;
    EXPECT_EQ(CountRight(scene, *view), 15);
    EXPECT_EQ(view->balls.size(), 15U);
  }
}

TEST(FindControlPoints, SameInputSameAnswer) {
  auto rng = MakeTestRng();
  const ControlScene scene = MakeControlScene(20, rng);
  const Image image = RenderScene(scene, 1);
  const auto seeds = DrawSeeds(scene, 8, rng);
  const auto a = Find(scene, image, seeds);
  const auto b = Find(scene, image, seeds);
  ASSERT_TRUE(a && b);
  ASSERT_EQ(a->balls.size(), b->balls.size());
  for (std::size_t i = 0; i < a->balls.size(); ++i) {
    EXPECT_EQ(a->balls[i].ball.center_px, b->balls[i].ball.center_px);
  }
  EXPECT_EQ(a->dlt, b->dlt);
}

}  // namespace
}  // namespace stereomotion
