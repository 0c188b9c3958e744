// The noise is learned from each camera's first images, of a recording and of live cameras alike.

#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "stereomotion/pipeline/measure.h"
#include "tests/simulation/test_scenario.h"
#include "tests/support/coming_pairs.h"
#include "tests/support/simulated_pairs.h"

namespace stereomotion::testing {
namespace {

RunSummary Measure(const PairSource& source) {
  const Scenario scenario = MakeTestScenario();
  MeasureSetup setup;
  setup.rig = scenario.rig;
  setup.bodies = {scenario.body};
  return MeasureRecording(source, setup, {}, [](const PairMeasurement&) { return true; });
}

RunSummary MeasureComing(std::vector<FramePair> pairs) {
  ComingPairs source(std::move(pairs));
  std::thread feeder = source.Feed(std::chrono::milliseconds(0));
  RunSummary summary = Measure(source);
  feeder.join();
  EXPECT_EQ(source.broken_rules(), 0);
  return summary;
}

std::string WarningsOf(const RunSummary& summary) {
  std::string all;
  for (const std::string& warning : summary.warnings) all += warning + "\n";
  return all;
}

void ExpectEqual(const NoiseRecord& a, const NoiseRecord& b) {
  EXPECT_EQ(a.origin, b.origin);
  EXPECT_EQ(a.pairs_used, b.pairs_used);
  EXPECT_EQ(a.noise.gain_e_per_dn, b.noise.gain_e_per_dn);
  EXPECT_EQ(a.noise.read_e, b.noise.read_e);
}

TEST(LearnNoise, OneCameraMayBeginLater) {
  std::vector<FramePair> pairs(30);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    RenderPair(MakeTestScenario(), static_cast<std::int64_t>(i), pairs[i]);
    if (i < 20) pairs[i].right = {};
  }
  const RunSummary live = MeasureComing(pairs);
  for (const NoiseRecord& noise : {live.noise_left, live.noise_right}) {
    EXPECT_EQ(noise.origin, "learned");
    EXPECT_EQ(noise.pairs_used, MeasureOptions().noise_pairs);
  }
  const RunSummary replayed = Measure(StoredPairs(pairs));
  ExpectEqual(replayed.noise_left, live.noise_left);
  ExpectEqual(replayed.noise_right, live.noise_right);
}

TEST(LearnNoise, AdviceIsOneThatCanBeFollowed) {
  std::vector<FramePair> pairs(40);
  for (FramePair& pair : pairs) pair.left.problem = pair.right.problem = "left out";
  EXPECT_NE(WarningsOf(Measure(StoredPairs(pairs))).find("(--start)"), std::string::npos);
  const std::string live = WarningsOf(MeasureComing(pairs));
  EXPECT_NE(live.find("noise could not be learned"), std::string::npos);
  EXPECT_EQ(live.find("--start"), std::string::npos) << live;
}

TEST(LearnNoise, NothingIsSaidWhereNothingCame) {
  EXPECT_EQ(WarningsOf(MeasureComing({})).find("noise"), std::string::npos);
}

}  // namespace
}  // namespace stereomotion::testing
