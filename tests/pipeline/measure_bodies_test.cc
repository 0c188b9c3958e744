#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "stereomotion/pipeline/measure.h"
#include "tests/simulation/test_scenario.h"
#include "tests/support/simulated_pairs.h"

namespace stereomotion::testing {
namespace {

constexpr std::int64_t kPairs = 6;

/// Two bodies that move on their own, 120 mm apart; their balls cross in the images.
std::array<Scenario, 2> MakeScenarios() {
  std::array<Scenario, 2> scenarios{MakeTestScenario(), MakeTestScenario()};
  scenarios[0].motion.center_in_world_mm = {-20, -60, 0};
  scenarios[1].body.name = "other";
  scenarios[1].body.rods[0].balls_in_body_mm = {
      {-95, 0, 0}, {-40, 0, 0}, {0, 0, 0}, {22, 0, 0}, {90, 0, 0}};
  scenarios[1].body.rods[1].balls_in_body_mm = {
      {0, -75, 30}, {0, -50, 30}, {0, 5, 30}, {0, 50, 30}, {0, 72, 30}};
  scenarios[1].motion.center_in_world_mm = {20, 60, 40};
  scenarios[1].motion.spin_in_world_rad_s = {-0.5, 0.4, -1.5};
  return scenarios;
}

/// Lays one image over the other: whatever is brighter is seen.
void Overlay(const Image& other, Image& image) {
  const ImageView view = image.View();
  for (int v = 0; v < view.height_px; ++v) {
    auto* row = image.Row<std::uint8_t>(v);
    const auto* other_row = other.View().Row<std::uint8_t>(v);
    std::transform(row, row + view.width_px, other_row, row,
                   [](std::uint8_t a, std::uint8_t b) { return std::max(a, b); });
  }
}

const std::vector<FramePair>& RenderedPairs() {
  static const std::vector<FramePair> pairs = [] {
    std::vector<FramePair> rendered(kPairs);
    for (std::int64_t i = 0; i < kPairs; ++i) {
      FramePair& pair = rendered[static_cast<std::size_t>(i)];
      FramePair other;
      RenderPair(MakeScenarios()[0], i, pair);
      RenderPair(MakeScenarios()[1], i, other);
      Overlay(other.left.image, pair.left.image);
      Overlay(other.right.image, pair.right.image);
    }
    return rendered;
  }();
  return pairs;
}

class MeasureBodiesTest : public ::testing::Test {
 protected:
  MeasureBodiesTest() {
    const auto scenarios = MakeScenarios();
    setup_.rig = scenarios[0].rig;
    for (RigCamera& camera : setup_.rig.cameras) camera.noise = scenarios[0].sensor.noise();
    for (const Scenario& scenario : scenarios) setup_.bodies.push_back(scenario.body);
  }
  std::vector<PairMeasurement> Measure(int search_every = 1) {
    MeasureOptions options;
    options.threads = 2;
    options.search_every = search_every;
    std::vector<PairMeasurement> measurements;
    summary_ = MeasureRecording(StoredPairs(RenderedPairs()), setup_, options,
                                [&](const PairMeasurement& measurement) {
                                  measurements.push_back(measurement);
                                  return true;
                                });
    return measurements;
  }
  MeasureSetup setup_;
  RunSummary summary_;
};

TEST_F(MeasureBodiesTest, EachIsWhereItIs) {
  const auto scenarios = MakeScenarios();
  for (const int search_every : {1, 3}) {
    const auto measurements = Measure(search_every);
    ASSERT_EQ(measurements.size(), 2 * static_cast<std::size_t>(kPairs));
    EXPECT_EQ(summary_.pairs_read, kPairs);
    EXPECT_EQ(summary_.poses, kPairs);
    for (std::size_t i = 0; i < measurements.size(); ++i) {
      const PairMeasurement& measurement = measurements[i];
      ASSERT_EQ(measurement.body, static_cast<int>(i % 2));
      ASSERT_EQ(measurement.frame, static_cast<std::int64_t>(i / 2));
      ASSERT_TRUE(measurement.pose) << i;
      const Scenario& scenario = scenarios[i % 2];
      const Rigid3 truth =
          StateAt(scenario.motion, TimeOfFrame(scenario, 0, measurement.frame).true_s)
              .world_from_body;
      const Vector6d error = PerturbationBetween(truth, measurement.pose->world_from_body);
      const Vector6d sigma = measurement.pose->covariance.diagonal().cwiseSqrt();
      EXPECT_LT(error.cwiseQuotient(sigma).cwiseAbs().maxCoeff(), 5) << i;
    }
  }
}

TEST_F(MeasureBodiesTest, OrderDecidesNothing) {
  const auto one = Measure();
  std::swap(setup_.bodies[0], setup_.bodies[1]);
  const auto other = Measure();
  EXPECT_EQ(summary_.bodies[0].name, "other");
  for (std::size_t i = 0; i < one.size(); ++i) {
    const PairMeasurement& same = other[i % 2 == 0 ? i + 1 : i - 1];
    ASSERT_EQ(one[i].pose.has_value(), same.pose.has_value()) << i;
    if (!one[i].pose) continue;
    EXPECT_EQ(one[i].pose->world_from_body.translation_mm,
              same.pose->world_from_body.translation_mm);
    EXPECT_EQ(one[i].pose->covariance, same.pose->covariance);
  }
}

/// What no pair shows is told of that body alone.
TEST_F(MeasureBodiesTest, AbsentBody) {
  for (Eigen::Vector3d& ball_mm : setup_.bodies[1].rods[0].balls_in_body_mm) ball_mm.x() *= 1.2;
  for (Eigen::Vector3d& ball_mm : setup_.bodies[1].rods[1].balls_in_body_mm) ball_mm.y() *= 0.8;
  Measure();
  EXPECT_EQ(summary_.poses, 0);  // of all bodies
  EXPECT_EQ(summary_.bodies[0].poses, kPairs);
  EXPECT_EQ(summary_.bodies[1].poses, 0);
  std::int64_t lost = 0;
  for (const auto& [reason, count] : summary_.lost_by_reason) lost += count;
  EXPECT_EQ(lost, kPairs);
  ASSERT_FALSE(summary_.warnings.empty());
  EXPECT_EQ(summary_.warnings.front().find("body 'other': "), 0U) << summary_.warnings.front();
}

}  // namespace
}  // namespace stereomotion::testing
