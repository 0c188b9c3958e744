#include "stereomotion/pipeline/learn_mask.h"

#include <gtest/gtest.h>

#include "pipeline/lowest_levels.h"
#include "tests/simulation/test_scenario.h"
#include "tests/support/simulated_pairs.h"

namespace stereomotion::testing {
namespace {

constexpr std::int64_t kPairs = 12;

/// A body that flies by a lamp, no ball where another one was.
Scenario MakeScene() {
  Scenario scenario = MakeTestScenario();
  scenario.motion.law = "uniform";
  scenario.motion.center_in_world_mm = {-45, -35, 0};
  scenario.motion.velocity_in_world_mm_s = {200, 160, 0};
  scenario.sensor.exposure_s = 0.001;
  scenario.false_balls = {{{110, 90, 40}, 9}};
  scenario.frames = kPairs;
  return scenario;
}

class LearnMaskTest : public ::testing::Test {
 protected:
  Expected<LearnedMask, MaskFailure> Learn(const std::function<Scenario(std::int64_t)>& at,
                                           std::int64_t pairs = kPairs) {
    const Scenario scenario = MakeScene();
    MeasureSetup setup{scenario.rig, 0, 1, {scenario.body}, {}, {}};
    for (RigCamera& camera : setup.rig.cameras) camera.noise = scenario.sensor.noise();
    MeasureOptions options;
    options.threads = 2;
    std::vector<FramePair> rendered(static_cast<std::size_t>(pairs));
    for (std::int64_t i = 0; i < pairs; ++i) {
      RenderPair(at(i), i, rendered[static_cast<std::size_t>(i)]);
    }
    return LearnMask(StoredPairs(std::move(rendered)), setup, options);
  }
  /// Where the lamp is in one camera.
  static Eigen::Vector2d Lamp(int camera) {
    const Scenario scenario = MakeScene();
    return *ProjectWorldPoint(scenario.rig.cameras[static_cast<std::size_t>(camera)],
                              scenario.false_balls[0].p_in_world_mm);
  }
  static bool Covers(const StaticPlace& place, const Eigen::Vector2d& p_px) {
    ImageMask mask(320, 256);
    MarkPolygon(place.outline, mask);
    return mask.IsMasked(static_cast<int>(p_px.x() + 0.5), static_cast<int>(p_px.y() + 0.5));
  }
};

TEST_F(LearnMaskTest, TheLampAndNothingElse) {
  const auto learned = Learn([](std::int64_t) { return MakeScene(); });
  ASSERT_TRUE(learned);
  EXPECT_EQ(learned->pairs, kPairs);
  for (const int camera : {0, 1}) {
    const auto& masked = learned->masked[static_cast<std::size_t>(camera)];
    ASSERT_EQ(masked.size(), 1U);
    EXPECT_TRUE(Covers(masked[0], Lamp(camera)));
    EXPECT_FALSE(Covers(masked[0], Lamp(camera) + Eigen::Vector2d(20, 0)));
    const auto& resting = learned->resting_balls[static_cast<std::size_t>(camera)];
    EXPECT_TRUE(resting.empty()) << resting[0].area_px << " px around "
                                 << resting[0].outline[0].transpose();
  }
}

TEST_F(LearnMaskTest, WithoutTheBody) {
  const auto learned = Learn([](std::int64_t) {
    Scenario scenario = MakeScene();
    scenario.body.rods = {{"behind", 14, {{0, 0, -9000}, {0, 99, -9000}, {50, 0, -9000}}, 0}};
    return scenario;
  });
  ASSERT_TRUE(learned);
  EXPECT_EQ(learned->run.poses, 0);
  EXPECT_EQ(learned->masked[0].size(), 1U);
  EXPECT_EQ(learned->masked[1].size(), 1U);
}

TEST_F(LearnMaskTest, BodyAtRest) {
  const auto learned = Learn([](std::int64_t) {
    Scenario scenario = MakeScene();
    scenario.motion.spin_in_world_rad_s.setZero();
    scenario.motion.velocity_in_world_mm_s.setZero();
    return scenario;
  });
  ASSERT_FALSE(learned);
  EXPECT_EQ(learned.error().problem, MaskProblem::kBodyAtRest);
}

/// The body of another shape than body.yaml says stands still.
TEST_F(LearnMaskTest, RestingBodyThatIsNotRecognised) {
  const auto learned = Learn([](std::int64_t) {
    Scenario scenario = MakeScene();
    scenario.motion.spin_in_world_rad_s.setZero();
    scenario.motion.velocity_in_world_mm_s.setZero();
    scenario.motion.center_in_world_mm.setZero();
    scenario.body.rods = {{"other", 14, {{-60, 0, 0}, {-41, 0, 0}, {5, 0, 0}, {66, 0, 0}}, 0}};
    return scenario;
  });
  ASSERT_FALSE(learned);
  EXPECT_EQ(learned.error().problem, MaskProblem::kMayBeBody);
  EXPECT_EQ(learned.error().run.poses, 0);
  EXPECT_FALSE(learned.error().run.warnings.empty());
}

TEST_F(LearnMaskTest, LampThatIsOftenOff) {
  const auto learned = Learn([](std::int64_t frame) {
    Scenario scenario = MakeScene();
    if (frame % 4 == 0) scenario.false_balls.clear();
    return scenario;
  });
  ASSERT_TRUE(learned);
  EXPECT_TRUE(learned->masked[0].empty());
}

TEST_F(LearnMaskTest, TooFewPairs) {
  const auto learned = Learn([](std::int64_t) { return MakeScene(); }, 9);
  ASSERT_FALSE(learned);
  EXPECT_EQ(learned.error().problem, MaskProblem::kTooFewPairs);
}

TEST(LowestLevels, KeepsTheLowestOfEachPixel) {
  Image image;
  image.Resize(2, 1, PixelType::kGray16);
  LowestLevels levels(2);
  for (const auto& [a, b] : {std::pair{7, 500}, {9, 3}, {8, 65535}, {4, 40}}) {
    image.Row<std::uint16_t>(0)[0] = static_cast<std::uint16_t>(a);
    image.Row<std::uint16_t>(0)[1] = static_cast<std::uint16_t>(b);
    levels.Add(image.View());
  }
  const Image highest = levels.Highest();  // the second lowest
  EXPECT_EQ(highest.View().At(0, 0), 7);
  EXPECT_EQ(highest.View().At(1, 0), 40);
  EXPECT_EQ(levels.images(), 4);
}

TEST(BrightestNeighbours, TakesTheBrightestOfNine) {
  Image image;
  image.Resize(5, 4, PixelType::kGray8);
  for (int v = 0; v < 4; ++v) std::fill_n(image.Row<std::uint8_t>(v), 5, std::uint8_t{10});
  image.Row<std::uint8_t>(1)[3] = 90;
  const Image brightest = BrightestNeighbours(image.View());
  for (int v = 0; v < 4; ++v) {
    for (int u = 0; u < 5; ++u) {
      const bool near = std::abs(u - 3) <= 1 && std::abs(v - 1) <= 1;
      EXPECT_EQ(brightest.View().At(u, v), near ? 90 : 10);
    }
  }
}

}  // namespace
}  // namespace stereomotion::testing
