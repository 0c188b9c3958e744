#include <gtest/gtest.h>

#include <map>

#include "simulated_camera.h"
#include "src/capture/live/frame_matcher.h"

namespace stereomotion {
namespace {

using testing::kHostAtZeroNs;
using testing::kMs;
using testing::kSecond;
using testing::Outage;
using testing::ReadInstant;
using testing::Simulate;
using testing::SimulatedCamera;
using testing::SimulatedFrame;
using testing::Stall;
using testing::WriteInstant;

constexpr std::int64_t kHour = 3600 * kSecond;
constexpr std::int64_t kPeriod = 16'666'667;

struct Scene {
  std::array<SimulatedCamera, 2> cameras;
  double seconds = 10;
  bool shared = false;
  std::optional<std::int64_t> tolerance_ns;
};

/// What came out, and how wrong the worst pair is.
struct Outcome {
  std::int64_t pairs = 0, left_alone = 0, right_alone = 0, left = 0, right = 0;
  std::int64_t worst_ns = 0;   ///< true time difference within a pair
  std::int64_t possible = 0;   ///< left images whose partner arrived too
  std::int64_t latest_ns = 0;  ///< longest wait of a left image for being given away
  bool in_order = true;
  MatcherSummary summary;
  ClockRelation relation{};
  bool free_running = false;
  std::optional<double> drift_ppm;
};

class Run {
 public:
  Run(const Scene& scene, std::uint32_t seed)
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

Outcome Match(const Scene& scene, std::uint32_t seed) { return Run(scene, seed).outcome(); }

void ExpectAllGivenOnce(const Outcome& outcome) {
  EXPECT_EQ(outcome.pairs + outcome.left_alone, outcome.left);
  EXPECT_EQ(outcome.pairs + outcome.right_alone, outcome.right);
  EXPECT_EQ(outcome.summary.pairs, outcome.pairs);
  EXPECT_EQ(outcome.summary.unpaired[0], outcome.left_alone);
  EXPECT_EQ(outcome.summary.unpaired[1], outcome.right_alone);
  EXPECT_TRUE(outcome.in_order);
}

/// Every pair is one instant, and all but so many pairs that were possible are there.
void ExpectRight(const Outcome& outcome, std::int64_t missing) {
  ExpectAllGivenOnce(outcome);
  EXPECT_EQ(outcome.worst_ns, 0);
  EXPECT_GE(outcome.pairs, outcome.possible - missing);
  EXPECT_FALSE(outcome.free_running);
}

Scene Offset(double rate_hz = 60) {
  Scene scene;
  for (SimulatedCamera& camera : scene.cameras) camera.period_ns = 1e9 / rate_hz;
  scene.cameras[1].clock_ns = -5 * kHour + 123'456'789;
  return scene;
}

TEST(FrameMatcher, OneClock) {
  for (std::uint32_t seed = 0; seed < 10; ++seed) {
    Scene scene;
    scene.shared = true;
    const Outcome outcome = Match(scene, seed);
    ExpectRight(outcome, 0);
    EXPECT_EQ(outcome.relation, ClockRelation::kShared);
    EXPECT_LT(std::abs(outcome.summary.skew_ns), 1000);
    EXPECT_NEAR(outcome.summary.jitter_ns, 1414, 300);
  }
}

TEST(FrameMatcher, ClocksThatAgreeAreTakenForOne) {
  for (std::uint32_t seed = 0; seed < 10; ++seed) {
    const Outcome outcome = Match(Scene{}, seed);
    ExpectRight(outcome, 0);
    EXPECT_EQ(outcome.relation, ClockRelation::kAgreeing);
  }
}

TEST(FrameMatcher, ClocksHoursApartThatDrift) {
  for (std::uint32_t seed = 0; seed < 30; ++seed) {
    Scene scene = Offset(seed % 2 == 0 ? 60 : 200);
    scene.cameras[0].drift = 50e-6;
    scene.cameras[1].drift = -50e-6;
    scene.seconds = seed == 0 ? 120 : 20;
    const Outcome outcome = Match(scene, seed);
    ExpectRight(outcome, 0);
    EXPECT_EQ(outcome.relation, ClockRelation::kEstimated);
    EXPECT_LT(outcome.summary.jitter_ns, 20e3);
    if (scene.seconds > 100) {
      ASSERT_TRUE(outcome.drift_ppm);
      EXPECT_NEAR(*outcome.drift_ppm, -100, 5);
    }
  }
}

TEST(FrameMatcher, AgreeingClocksThatDriftApart) {
  Scene scene;
  scene.cameras[1].drift = 200e-6;
  scene.seconds = 100;  // 20 ms: more than a period
  for (std::uint32_t seed = 0; seed < 5; ++seed) {
    const Outcome outcome = Match(scene, seed);
    ExpectRight(outcome, 0);
    EXPECT_EQ(outcome.relation, ClockRelation::kEstimated);
  }
}

TEST(FrameMatcher, ImagesLostInBothCameras) {
  for (std::uint32_t seed = 0; seed < 30; ++seed) {
    Scene scene = Offset();
    scene.cameras[0].lost = 0.1;
    scene.cameras[1].lost = 0.2;
    ExpectRight(Match(scene, seed), 0);
  }
}

TEST(FrameMatcher, StalledNetwork) {
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    Scene scene = Offset(seed % 2 == 0 ? 60 : 200);
    std::mt19937 random(seed);
    for (SimulatedCamera& camera : scene.cameras) {
      for (std::int64_t at_ns = static_cast<std::int64_t>(random() % 200) * kMs;
           at_ns < 10 * kSecond; at_ns += (300 + random() % 1000) * kMs) {
        camera.stalls.push_back({at_ns, 100 * kMs});
      }
    }
    if (seed % 3 == 0)
      scene.cameras[1].stalls.insert(scene.cameras[1].stalls.begin(), {0, 150 * kMs});
    ExpectRight(Match(scene, seed), 0);
  }
}

TEST(FrameMatcher, OneCameraSilentForASecond) {
  for (const int silent : {0, 1}) {
    Scene scene = Offset();
    scene.cameras[static_cast<std::size_t>(silent)].silences.push_back({3 * kSecond, kSecond});
    const Outcome outcome = Match(scene, 1);
    ExpectRight(outcome, 0);
    EXPECT_NEAR(static_cast<double>(silent == 0 ? outcome.right_alone : outcome.left_alone), 60, 1);
    EXPECT_LT(outcome.latest_ns, 700 * kMs);  // a bounded wait
  }
}

TEST(FrameMatcher, ACameraRestarts) {
  for (std::uint32_t seed = 0; seed < 30; ++seed) {
    Scene scene = Offset(seed % 2 == 0 ? 60 : 200);
    const auto restarted = seed % 3 == 0 ? 0U : 1U;
    scene.cameras[restarted].outages.push_back({4 * kSecond, kSecond, 40 * kHour});
    if (seed % 3 == 2) scene.cameras[0].outages.push_back({6 * kSecond, kSecond / 2, 77 * kSecond});
    scene.cameras[0].first_id = 65401;
    const Outcome outcome = Match(scene, seed);
    ExpectRight(outcome, 4);
  }
}

TEST(FrameMatcher, CamerasThatAreNotTriggeredTogether) {
  for (const bool shared : {true, false}) {
    Scene scene;
    if (!shared) scene = Offset();
    scene.shared = shared;
    scene.cameras[1].phase_ns = 47 * kPeriod / 100;
    const Outcome outcome = Match(scene, 3);
    ExpectAllGivenOnce(outcome);
    EXPECT_EQ(outcome.pairs, 0);
    EXPECT_TRUE(outcome.free_running);
    EXPECT_NEAR(outcome.summary.phase_ns, 0.47 * kPeriod, 1e6) << shared;
  }
}

TEST(FrameMatcher, OneCameraThreePerMilleFaster) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    Scene scene = seed % 2 == 0 ? Scene{} : Offset();
    scene.shared = seed % 4 == 0;
    scene.cameras[1].period_ns *= 0.997;
    scene.cameras[1].phase_ns = static_cast<std::int64_t>(seed) * kPeriod / 20;
    scene.seconds = 30;
    const Outcome outcome = Match(scene, seed);
    ExpectAllGivenOnce(outcome);
    EXPECT_TRUE(outcome.free_running) << seed;
    EXPECT_GT(outcome.pairs, 400) << seed;  // a good half of the time they are near
    // By device time where there is one clock, else with a millisecond for the arrivals.
    const std::int64_t bound_ns = kPeriod / 4 + (scene.shared ? 10'000 : kMs);
    EXPECT_LT(outcome.worst_ns, bound_ns) << seed;
  }
}

TEST(FrameMatcher, SlowCrystalsOfFreeRunningCamerasAreSeenInTime) {
  Scene scene = Offset();
  scene.cameras[1].drift = 60e-6;  // its own clock times its images, and both are slow
  scene.cameras[1].period_ns /= 1 + 60e-6;
  scene.seconds = 120;  // 7 ms
  const Outcome outcome = Match(scene, 5);
  ExpectAllGivenOnce(outcome);
  EXPECT_TRUE(outcome.free_running);
  EXPECT_LT(outcome.worst_ns, kPeriod / 4 + kMs);
}

TEST(FrameMatcher, ArrivalsTooRoughForThePeriodGiveNoPair) {
  Scene scene = Offset(200);
  for (SimulatedCamera& camera : scene.cameras) camera.delay_jitter_ns = 30e6;
  scene.seconds = 4;
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    const Outcome outcome = Match(scene, seed);
    ExpectAllGivenOnce(outcome);
    EXPECT_EQ(outcome.worst_ns, 0);
  }
}

TEST(FrameMatcher, AClockThatIsSetWhileItStreams) {
  std::uint32_t seed = 0;
  for (const std::size_t camera : {0U, 1U}) {
    for (const double periods :
         {-600.0, -6.0, -2.1, -1.0, -0.9, -0.4, 0.4, 0.9, 1.0, 2.1, 6.0, 600.0}) {
      Scene scene = Offset();
      const auto by_ns = static_cast<std::int64_t>(periods * kPeriod);
      scene.cameras[camera].clock_steps.push_back({4 * kSecond, by_ns});
      scene.cameras[1 - camera].lost = 0.1;
      const Outcome outcome = Match(scene, ++seed);
      EXPECT_EQ(outcome.worst_ns, 0) << periods;
      EXPECT_TRUE(outcome.in_order);
      EXPECT_GE(outcome.pairs, outcome.possible - 160) << periods;
    }
  }
}

TEST(FrameMatcher, NumbersThatMissAnImageCostNothing) {
  Scene scene = Offset();
  const Outcome before = Match(scene, 1);
  scene.cameras[1].forgets_number_at_ns = 5 * kSecond;
  const Outcome outcome = Match(scene, 1);
  ExpectRight(outcome, 0);
  EXPECT_EQ(before.summary.given_up, 0);
  EXPECT_EQ(outcome.summary.given_up, 1);
}

/// A camera with faults of every kind; its shortest delay is a share of the period up to `delay`.
SimulatedCamera Faulty(double period_ns, double delay, std::mt19937_64& random) {
  const auto uniform = [&](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  SimulatedCamera camera;
  camera.period_ns = period_ns;
  camera.clock_ns = static_cast<std::int64_t>(uniform(0, 1) < 0.3 ? uniform(-2, 2) * period_ns
                                                                  : uniform(-1, 1) * 1e17);
  camera.drift = uniform(-100e-6, 100e-6);
  camera.delay_ns = static_cast<std::int64_t>(uniform(0.05, delay) * period_ns);
  camera.delay_jitter_ns = uniform(0, 0.3) * period_ns;
  camera.stamp_jitter_ns = uniform(10, 2000);
  camera.lost = uniform(0, 1) < 0.5 ? uniform(0, 0.3) : 0;
  for (double at_s = uniform(0, 2); at_s < 10; at_s += uniform(0.3, 3)) {
    camera.stalls.push_back({static_cast<std::int64_t>(at_s * 1e9),
                             static_cast<std::int64_t>(uniform(0.01, 0.4) * 1e9)});
  }
  if (uniform(0, 1) < 0.5) {
    camera.silences.push_back({static_cast<std::int64_t>(uniform(0, 9) * 1e9), kSecond});
  }
  if (uniform(0, 1) < 0.5) {
    camera.outages.push_back({static_cast<std::int64_t>(uniform(1, 7) * 1e9),
                              static_cast<std::int64_t>(uniform(0.2, 2) * 1e9),
                              static_cast<std::int64_t>(uniform(-1, 1) * 1e17)});
  }
  return camera;
}

TEST(FrameMatcher, AnyMixOfFaultsGivesNoWrongPair) {
  std::int64_t pairs = 0, possible = 0;
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    std::mt19937_64 random(seed);
    const double rate_hz = std::exp(std::uniform_real_distribution<double>(2, 6)(random));
    Scene scene;
    for (SimulatedCamera& camera : scene.cameras)
      camera = Faulty(1e9 / rate_hz, seed < 100 ? 0.15 : 0.6, random);
    const Outcome outcome = Match(scene, seed);
    EXPECT_EQ(outcome.worst_ns, 0) << "seed " << seed << ", " << rate_hz << " Hz";
    EXPECT_TRUE(outcome.in_order) << seed;
    if (seed >= 100) continue;  // their delays may differ by too much for any pair to be told
    pairs += outcome.pairs;
    possible += outcome.possible;
  }
  EXPECT_GT(pairs, 95 * possible / 100);
}

TEST(FrameMatcher, ImagesThatAreNotLaterAreDropped) {
  FrameMatcher matcher({std::nullopt, 512}, [](const auto&, const auto&) {});
  std::int64_t id = 0;
  for (const std::int64_t device_us : {10'000, 20'000, 20'000, 19'900, 30'000}) {
    const std::int64_t device_ns = 1000 * device_us;
    matcher.Take(0, {std::make_shared<Frame>(), id++, device_ns, device_ns, 0});
  }
  EXPECT_EQ(matcher.summary().misdated[0], 2);
}

}  // namespace
}  // namespace stereomotion
