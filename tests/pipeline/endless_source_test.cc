// Live cameras are a source whose end nobody knows: the same pairs give the same measurements.

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

#include "stereomotion/pipeline/measure.h"
#include "tests/simulation/test_scenario.h"
#include "tests/support/simulated_pairs.h"

namespace stereomotion::testing {
namespace {

constexpr std::int64_t kPairs = 12;

/// Delivers pairs as they "come", and holds its reader to the rules of `PairSource`.
class ComingPairs : public PairSource {
 public:
  explicit ComingPairs(std::vector<FramePair> pairs) : pairs_(std::move(pairs)) {}
  [[nodiscard]] std::int64_t size() const override { return kEndlessSource; }
  bool Read(std::int64_t position, FramePair& pair) const override {
    std::unique_lock<std::mutex> lock(mutex_);
    came_.wait(lock, [&] { return position < there_ || ended_; });
    if (position >= there_) return false;
    CheckRules(position);
    pair = pairs_[static_cast<std::size_t>(position)];
    return true;
  }
  void LetCome(std::int64_t pairs) {
    const std::lock_guard<std::mutex> lock(mutex_);
    there_ = pairs;
    came_.notify_all();
  }
  void End() {
    const std::lock_guard<std::mutex> lock(mutex_);
    ended_ = true;
    came_.notify_all();
  }
  /// Lets all come, one after the other, from a thread.
  std::thread Feed(std::chrono::milliseconds period) {
    return std::thread([this, period] {
      for (std::int64_t i = 1; i <= static_cast<std::int64_t>(pairs_.size()); ++i) {
        std::this_thread::sleep_for(period);
        LetCome(i);
      }
      End();
    });
  }
  [[nodiscard]] int broken_rules() const { return broken_rules_; }

 private:
  void CheckRules(std::int64_t position) const {
    const bool is_again = !read_.insert(position).second;
    if (position < kPairsKept ? latest_ >= kPairsKept && is_again : is_again) ++broken_rules_;
    latest_ = std::max(latest_, position);
  }
  std::vector<FramePair> pairs_;
  mutable std::mutex mutex_;
  mutable std::condition_variable came_;
  std::int64_t there_ = 0;
  bool ended_ = false;
  mutable std::set<std::int64_t> read_;
  mutable std::int64_t latest_ = -1;
  mutable int broken_rules_ = 0;
};

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
  source.LetCome(8);  // the noise is learned from eight
  std::atomic<std::int64_t> prompt_frame{-1};
  std::thread feeder([&] {
    while (prompt_frame < 7) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    source.End();  // only now: a prompt sink that waited for pair 9 would never hear of 7
  });
  std::int64_t measured = 0;
  MeasureRecording(
      source, setup_, options_, [&](const PairMeasurement&) { return ++measured > 0; }, nullptr,
      [&](const PromptPose& pose) {
        EXPECT_EQ(pose.pose != nullptr, pose.status == PoseStatus::kOk);
        prompt_frame = pose.frame;
      });
  feeder.join();
  EXPECT_EQ(measured, 8);
}

}  // namespace
}  // namespace stereomotion::testing
