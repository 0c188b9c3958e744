#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "stereomotion/pipeline/measure.h"
#include "tests/simulation/test_scenario.h"
#include "tests/support/simulated_pairs.h"

namespace stereomotion::testing {
namespace {

constexpr std::int64_t kPairs = 24;
constexpr int kEvery = 6;

/// The body flies through the images from left to right, so that balls enter and leave; during some
/// pairs one rod is switched off, as if hidden.
Scenario SceneOf(std::int64_t frame) {
  Scenario scenario = MakeTestScenario();
  scenario.motion.law = "uniform";
  scenario.motion.center_in_world_mm = {-170, 0, 0};
  scenario.motion.velocity_in_world_mm_s = {400, 0, 0};
  scenario.sensor.exposure_s = 0.001;
  if (frame >= 9 && frame < 13) scenario.body.rods.pop_back();
  return scenario;
}

const std::vector<FramePair>& RenderedPairs() {
  static const std::vector<FramePair> pairs = [] {
    std::vector<FramePair> rendered(kPairs);
    for (std::int64_t i = 0; i < kPairs; ++i) {
      RenderPair(SceneOf(i), i, rendered[static_cast<std::size_t>(i)]);
    }
    return rendered;
  }();
  return pairs;
}

class SearchEveryTest : public ::testing::Test {
 protected:
  SearchEveryTest() {
    const Scenario scenario = MakeTestScenario();
    setup_.rig = scenario.rig;
    setup_.bodies = {scenario.body};
    for (RigCamera& camera : setup_.rig.cameras) camera.noise = scenario.sensor.noise();
  }
  std::vector<PairMeasurement> Measure(int search_every, int threads) {
    MeasureOptions options;
    options.search_every = search_every;
    options.threads = threads;
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

bool Sees(const std::vector<MatchedDetection>& detections, const Eigen::Vector2d& center_px) {
  return std::any_of(detections.begin(), detections.end(), [&](const MatchedDetection& one) {
    return (one.observation.center_px - center_px).norm() < 1;
  });
}

/// How many pairs in a row one camera misses what a whole search sees. Balls move 10 px a pair, and
/// a new one is followed from its first sight on, so a miss can only be one that has come into
/// sight since.
int LongestMiss(const std::vector<PairMeasurement>& whole, const std::vector<PairMeasurement>& part,
                std::vector<MatchedDetection> PairMeasurement::*camera) {
  int longest = 0, run = 0;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    const auto& all = whole[i].*camera;
    const bool complete =
        std::all_of(all.begin(), all.end(), [&](const MatchedDetection& detection) {
          return detection.observation.status != BlobStatus::kOk ||
                 Sees(part[i].*camera, detection.observation.center_px);
        });
    run = complete ? 0 : run + 1;
    longest = std::max(longest, run);
  }
  return longest;
}

TEST_F(SearchEveryTest, BallsThatComeIntoSightAreFoundInTime) {
  const auto whole = Measure(1, 2);
  EXPECT_EQ(summary_.whole_searches_left, kPairs);
  const auto part = Measure(kEvery, 2);
  EXPECT_LT(summary_.whole_searches_left, kPairs);
  EXPECT_LT(summary_.whole_searches_right, kPairs);
  ASSERT_EQ(part.size(), whole.size());
  EXPECT_LE(LongestMiss(whole, part, &PairMeasurement::left), kEvery - 1);
  EXPECT_LE(LongestMiss(whole, part, &PairMeasurement::right), kEvery - 1);
}

/// A ball in a window is measured as in a whole search.
TEST_F(SearchEveryTest, NothingElseIsSeen) {
  const auto whole = Measure(1, 2);
  const auto part = Measure(kEvery, 2);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    for (const MatchedDetection& detection : part[i].left) {
      if (detection.observation.status != BlobStatus::kOk) continue;
      EXPECT_TRUE(Sees(whole[i].left, detection.observation.center_px)) << i;
    }
  }
}

TEST_F(SearchEveryTest, ThreadsChangeNothing) {
  const auto one = Measure(kEvery, 1);
  const auto four = Measure(kEvery, 4);
  ASSERT_EQ(one.size(), four.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    ASSERT_EQ(one[i].left.size(), four[i].left.size()) << i;
    for (std::size_t j = 0; j < one[i].left.size(); ++j) {
      EXPECT_EQ(one[i].left[j].observation.center_px, four[i].left[j].observation.center_px);
    }
    ASSERT_EQ(one[i].pose.has_value(), four[i].pose.has_value());
    if (!one[i].pose) continue;
    EXPECT_EQ(one[i].pose->world_from_body.translation_mm,
              four[i].pose->world_from_body.translation_mm);
  }
}

TEST_F(SearchEveryTest, CallersMistakes) {
  EXPECT_THROW(Measure(0, 1), std::invalid_argument);
  setup_.left_mask = ImageMask(10, 10);
  EXPECT_THROW(Measure(1, 1), std::invalid_argument);
}

}  // namespace
}  // namespace stereomotion::testing
