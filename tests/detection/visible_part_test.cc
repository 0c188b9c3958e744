#include "src/detection/visible_part.h"

#include <gtest/gtest.h>

#include <vector>

#include "../support/rod_scene.h"
#include "../support/test_rng.h"

namespace stereomotion {
namespace {

constexpr SensorNoise kNoise{58.8, 8, 0, 255};
const std::vector<RodModel> kNoRods;

testing::RodScene TouchingBalls() {
  testing::RodScene scene;
  scene.balls.push_back({{24.2, 24.3}});
  scene.balls.push_back({{34.8, 25.1}});
  return scene;
}

PartQuery QueryOf(const testing::RodScene& scene) {
  PartQuery query;
  query.place_px = scene.balls[0].center_px;
  // The model's blur holds the pixel's aperture: √(0.6² + 1/12).
  query.usual = {scene.balls[0].radius_px, 0.67, scene.balls[0].amplitude_dn};
  query.background_dn = scene.background_dn;
  query.rods = &kNoRods;
  return query;
}

TEST(VisiblePart, WorkStaysWithinTheBudget) {
  auto rng = testing::MakeTestRng();
  const testing::RodScene scene = TouchingBalls();
  const Image image = RenderRodScene(scene, kNoise, rng);
  const PartQuery query = QueryOf(scene);
  VisiblePartFitter fitter;
  constexpr std::int64_t kAmple_px = 1000000;
  fitter.budget().Start(kAmple_px);
  ASSERT_TRUE(fitter.Fit(image.View(), kNoise, query));
  const std::int64_t needed_px = kAmple_px - fitter.budget().left_px();
  EXPECT_GT(needed_px, 0);
  // The last two fits of a part, of thirty steps each, are not broken off.
  const double reach_px = query.usual.radius_px + 7;
  const auto last_px = static_cast<std::int64_t>(62 * 4 * reach_px * reach_px);
  for (std::int64_t most_px = 1; most_px < needed_px; most_px += needed_px / 16 + 1) {
    fitter.budget().Start(most_px);
    static_cast<void>(fitter.Fit(image.View(), kNoise, query));
    EXPECT_GE(fitter.budget().left_px(), -last_px);
  }
}

TEST(VisiblePart, SpentBudgetFindsNothing) {
  auto rng = testing::MakeTestRng();
  const testing::RodScene scene = TouchingBalls();
  const Image image = RenderRodScene(scene, kNoise, rng);
  VisiblePartFitter fitter;
  fitter.budget().Start(1);
  EXPECT_FALSE(fitter.Fit(image.View(), kNoise, QueryOf(scene)));
}

TEST(VisiblePart, SameWorkEachTime) {
  auto rng = testing::MakeTestRng();
  const testing::RodScene scene = TouchingBalls();
  const Image image = RenderRodScene(scene, kNoise, rng);
  std::int64_t left_px[2];
  for (std::int64_t& left : left_px) {
    VisiblePartFitter fitter;
    fitter.budget().Start(1000000);
    static_cast<void>(fitter.Fit(image.View(), kNoise, QueryOf(scene)));
    left = fitter.budget().left_px();
  }
  EXPECT_EQ(left_px[0], left_px[1]);
}

}  // namespace
}  // namespace stereomotion
