#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "simulated_camera.h"
#include "src/capture/live/frame_matcher.h"

namespace stereomotion::testing {

constexpr std::int64_t kHour = 3600 * kSecond;
constexpr std::int64_t kPeriod = 16'666'667;

/// Two cameras, triggered together where nothing else is said.
struct Scene {
  std::array<SimulatedCamera, 2> cameras;
  double seconds = 10;
  bool shared = false;
  std::optional<std::int64_t> tolerance_ns;
};

/// What came out, and how wrong the worst pair is.
struct Outcome {
  std::int64_t pairs = 0, left_alone = 0, right_alone = 0, left = 0, right = 0;
  std::int64_t worst_ns = 0;        ///< true time difference within a pair
  std::int64_t last_wrong_ns = -1;  ///< true time of the last pair of two instants
  std::int64_t possible = 0;        ///< left images whose partner arrived too
  std::int64_t latest_ns = 0;       ///< longest wait of a left image for being given away
  bool in_order = true;
  MatcherSummary summary;
  ClockRelation relation{};
  bool free_running = false;
  std::optional<double> drift_ppm;
};

/// Feeds a scene to a matcher in the order of arrival.
class MatcherRun {
 public:
  MatcherRun(const Scene& scene, std::uint32_t seed)
      : matcher_({scene.tolerance_ns, 512},
                 [this](const auto& left, const auto& right) { Check(left, right); }) {
    if (scene.shared) matcher_.TakeOneClock();
    auto frames = Simulate(scene.cameras[0], 0, scene.seconds, seed);
    const auto right = Simulate(scene.cameras[1], 1, scene.seconds, seed);
    CountPossible(frames, right);
    frames.insert(frames.end(), right.begin(), right.end());
    std::stable_sort(frames.begin(), frames.end(),
                     [](const auto& a, const auto& b) { return a.host_ns < b.host_ns; });
    for (const SimulatedFrame& frame : frames) Feed(frame);
    matcher_.Finish();
    outcome_.summary = matcher_.summary();
    outcome_.relation = matcher_.clocks().relation();
    outcome_.free_running = matcher_.clocks().free_running();
    outcome_.drift_ppm = matcher_.clocks().drift_ppm();
  }
  [[nodiscard]] const Outcome& outcome() const { return outcome_; }

 private:
  void CountPossible(const std::vector<SimulatedFrame>& left,
                     const std::vector<SimulatedFrame>& right) {
    std::map<std::int64_t, int> instants;
    for (const auto& frame : right) ++instants[frame.instant_ns];
    for (const auto& frame : left)
      outcome_.possible += static_cast<std::int64_t>(instants.count(frame.instant_ns));
    outcome_.left = static_cast<std::int64_t>(left.size());
    outcome_.right = static_cast<std::int64_t>(right.size());
  }
  void Feed(const SimulatedFrame& simulated) {
    constexpr std::int64_t kTick = 20 * kMs;
    for (; now_ns_ + kTick < simulated.host_ns && now_ns_ > 0; now_ns_ += kTick) {
      matcher_.Advance(now_ns_);
    }
    now_ns_ = simulated.host_ns;
    LiveFrame frame{std::make_shared<Frame>(), simulated.id, simulated.device_ns, simulated.host_ns,
                    simulated.epoch};
    WriteInstant(simulated.instant_ns, 16, 1, frame.frame->image);
    matcher_.Take(simulated.camera, frame);
    matcher_.Advance(now_ns_);
  }
  void Check(const std::shared_ptr<Frame>& left, const std::shared_ptr<Frame>& right) {
    if (left && right) {
      ++outcome_.pairs;
      const std::int64_t apart_ns =
          std::llabs(ReadInstant(left->image) - ReadInstant(right->image));
      outcome_.worst_ns = std::max(outcome_.worst_ns, apart_ns);
      if (apart_ns > 0) outcome_.last_wrong_ns = ReadInstant(left->image);
    }
    outcome_.left_alone += left && !right ? 1 : 0;
    outcome_.right_alone += !left && right ? 1 : 0;
    if (left) CheckOrder(*left, last_left_);
    if (right) CheckOrder(*right, last_right_);
    if (left) {
      outcome_.latest_ns =
          std::max(outcome_.latest_ns, now_ns_ - kHostAtZeroNs - ReadInstant(left->image));
    }
  }
  void CheckOrder(const Frame& frame, Frame& last) {
    const bool rises = last.index < 0 || (frame.timestamp_ns > last.timestamp_ns);
    outcome_.in_order = outcome_.in_order && rises && frame.index > last.index;
    last.index = frame.index;
    last.timestamp_ns = frame.timestamp_ns;
  }

  Outcome outcome_;
  std::int64_t now_ns_ = 0;
  Frame last_left_, last_right_;
  FrameMatcher matcher_;
};

inline Outcome Match(const Scene& scene, std::uint32_t seed) {
  return MatcherRun(scene, seed).outcome();
}

inline void ExpectAllGivenOnce(const Outcome& outcome) {
  EXPECT_EQ(outcome.pairs + outcome.left_alone, outcome.left);
  EXPECT_EQ(outcome.pairs + outcome.right_alone, outcome.right);
  EXPECT_EQ(outcome.summary.pairs, outcome.pairs);
  EXPECT_EQ(outcome.summary.unpaired[0], outcome.left_alone);
  EXPECT_EQ(outcome.summary.unpaired[1], outcome.right_alone);
  EXPECT_TRUE(outcome.in_order);
}

/// Every pair is one instant, and all but so many pairs that were possible are there.
inline void ExpectRight(const Outcome& outcome, std::int64_t missing) {
  ExpectAllGivenOnce(outcome);
  EXPECT_EQ(outcome.worst_ns, 0);
  EXPECT_GE(outcome.pairs, outcome.possible - missing);
  EXPECT_FALSE(outcome.free_running);
}

/// Cameras whose clocks are hours apart.
inline Scene Offset(double rate_hz = 60) {
  Scene scene;
  for (SimulatedCamera& camera : scene.cameras) camera.period_ns = 1e9 / rate_hz;
  scene.cameras[1].clock_ns = -5 * kHour + 123'456'789;
  return scene;
}

}  // namespace stereomotion::testing
