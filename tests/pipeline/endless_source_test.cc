// Live cameras are a source whose end nobody knows: the same pairs give the same measurements.

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "stereomotion/pipeline/measure.h"
#include "tests/simulation/test_scenario.h"
#include "tests/support/coming_pairs.h"
#include "tests/support/simulated_pairs.h"

namespace stereomotion::testing {
namespace {

constexpr std::int64_t kPairs = 12;

std::vector<FramePair> Render(std::int64_t count) {
  std::vector<FramePair> pairs(static_cast<std::size_t>(count));
  for (std::int64_t i = 0; i < count; ++i) {
    RenderPair(MakeTestScenario(), i, pairs[static_cast<std::size_t>(i)]);
  }
  pairs[3].right = {};  // no partner
  return pairs;
}

const std::vector<FramePair>& Rendered() {
  static const std::vector<FramePair> pairs = Render(kPairs);
  return pairs;
}

struct Measured {
  std::vector<PairMeasurement> pairs;
  std::vector<PoseStatus> prompt;
  RunSummary summary;
};

class EndlessSource : public ::testing::Test {
 protected:
  EndlessSource() {
    const Scenario scenario = MakeTestScenario();
    setup_.rig = scenario.rig;
    setup_.bodies = {scenario.body};
    options_.threads = 2;
  }
  Measured Measure(const PairSource& source, bool with_prompt = true) {
    Measured measured;
    const MeasurementSink sink = [&](const PairMeasurement& measurement) {
      measured.pairs.push_back(measurement);
      return true;
    };
    const PromptSink prompt = [&](const PromptPose& pose) {
      measured.prompt.push_back(pose.status);
    };
    measured.summary = MeasureRecording(source, setup_, options_, sink, nullptr,
                                        with_prompt ? prompt : PromptSink());
    return measured;
  }
  Measured MeasureComing(std::vector<FramePair> pairs, int period_ms = 1) {
    ComingPairs source(std::move(pairs));
    std::thread feeder = source.Feed(std::chrono::milliseconds(period_ms));
    Measured measured = Measure(source);
    feeder.join();
    EXPECT_EQ(source.broken_rules(), 0);
    return measured;
  }
  MeasureSetup setup_;
  MeasureOptions options_;
};

void ExpectEqual(const Measured& a, const Measured& b) {
  ASSERT_EQ(a.pairs.size(), b.pairs.size());
  for (std::size_t i = 0; i < a.pairs.size(); ++i) {
    const PairMeasurement& one = a.pairs[i];
    const PairMeasurement& other = b.pairs[i];
    EXPECT_EQ(one.frame, other.frame);
    EXPECT_EQ(one.status, other.status);
    ASSERT_EQ(one.pose.has_value(), other.pose.has_value());
    if (!one.pose) continue;
    EXPECT_EQ(one.pose->world_from_body.translation_mm, other.pose->world_from_body.translation_mm);
    EXPECT_EQ(one.pose->world_from_body.rotation.coeffs(),
              other.pose->world_from_body.rotation.coeffs());
    EXPECT_EQ(one.pose->covariance, other.pose->covariance);
    EXPECT_EQ(one.left.size(), other.left.size());
  }
  EXPECT_EQ(a.summary.noise_left.noise.gain_e_per_dn, b.summary.noise_left.noise.gain_e_per_dn);
  EXPECT_EQ(a.summary.noise_left.pairs_used, b.summary.noise_left.pairs_used);
}

TEST_F(EndlessSource, GivesWhatARecordingOfTheSamePairsGives) {
  for (const int search_every : {1, 3}) {
    options_.search_every = search_every;
    options_.threads = 2;
    const Measured recorded = Measure(StoredPairs(Rendered()));
    EXPECT_EQ(recorded.summary.poses, kPairs - 1);
    EXPECT_EQ(recorded.summary.noise_left.origin, "learned");
    for (const int threads : {1, 2, 5}) {
      options_.threads = threads;
      ExpectEqual(recorded, MeasureComing(Rendered()));
    }
  }
}

TEST_F(EndlessSource, NoiseIsLearnedFromThePairsThatAreKept) {
  std::vector<FramePair> pairs(40);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    pairs[i].left.index = pairs[i].right.index = static_cast<std::int64_t>(i);
    pairs[i].left.problem = pairs[i].right.problem = "left out";
  }
  for (const FramePair& pair : Rendered()) pairs.push_back(pair);
  options_.noise_pairs = 40;
  const Measured measured = MeasureComing(pairs, 0);
  EXPECT_EQ(measured.summary.noise_left.origin, "default");
  ExpectEqual(Measure(StoredPairs(pairs)), measured);
}

TEST_F(EndlessSource, EndsBeforeTheFirstPair) {
  ComingPairs source(Rendered());
  source.End();
  const Measured measured = Measure(source);
  EXPECT_EQ(measured.summary.pairs_read, 0);
  EXPECT_TRUE(measured.pairs.empty());
}

TEST_F(EndlessSource, EndWhileAllThreadsWait) {
  options_.threads = 4;
  ComingPairs source(Rendered());
  source.LetCome(9);
  std::thread ender([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    source.End();
  });
  EXPECT_EQ(Measure(source).summary.pairs_read, 9);
  ender.join();
}

TEST_F(EndlessSource, DroppedPairsAreRowsOfTheirOwn) {
  std::vector<FramePair> pairs = Rendered();
  for (Frame* frame : {&pairs[6].left, &pairs[6].right}) {
    frame->image = {};
    frame->dropped = true;
  }
  pairs[3].left.image = {};  // has no partner: nothing was lost by dropping it
  pairs[3].left.dropped = true;
  const Measured measured = MeasureComing(pairs);
  EXPECT_EQ(measured.pairs[6].status, PoseStatus::kDropped);
  EXPECT_EQ(measured.pairs[6].detail, "");
  EXPECT_EQ(measured.summary.lost_by_reason,
            (std::map<std::string, std::int64_t>{{"dropped", 1}, {"no_pair", 1}}));
}

TEST_F(EndlessSource, PromptSinkHearsOfEveryPairAndChangesNothing) {
  const Measured with = Measure(StoredPairs(Rendered()), true);
  ExpectEqual(with, Measure(StoredPairs(Rendered()), false));
  ASSERT_EQ(with.prompt.size(), with.pairs.size());
  for (std::size_t i = 0; i < with.pairs.size(); ++i) {
    EXPECT_EQ(with.prompt[i], with.pairs[i].status);
  }
}

TEST_F(EndlessSource, PromptSinkHearsBeforeThePairsThatFollow) {
  ComingPairs source(Rendered());
  source.LetCome(9);  // the noise is learned from eight of each camera, and one has no partner
  std::atomic<std::int64_t> prompt_frame{-1};
  std::thread feeder([&] {
    while (prompt_frame < 8) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    source.End();  // only now: a prompt sink that waited for pair 10 would never hear of 8
  });
  std::int64_t measured = 0;
  MeasureRecording(
      source, setup_, options_, [&](const PairMeasurement&) { return ++measured > 0; }, nullptr,
      [&](const PromptPose& pose) {
        EXPECT_EQ(pose.pose != nullptr, pose.status == PoseStatus::kOk);
        prompt_frame = pose.frame;
      });
  feeder.join();
  EXPECT_EQ(measured, 9);
}

}  // namespace
}  // namespace stereomotion::testing
