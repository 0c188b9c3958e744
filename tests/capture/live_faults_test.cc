#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "matcher_run.h"

namespace stereomotion {
namespace {

using testing::ExpectAllGivenOnce;
using testing::ExpectRight;
using testing::kHour;
using testing::kMs;
using testing::kPeriod;
using testing::kSecond;
using testing::Match;
using testing::Offset;
using testing::Outcome;
using testing::Scene;
using testing::SimulatedCamera;

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

TEST(FrameMatcher, NumbersThatMissAnImageCostFewPairs) {
  Scene scene = Offset();
  const Outcome before = Match(scene, 1);
  scene.cameras[1].forgets_number_at_ns = 5 * kSecond;
  const Outcome outcome = Match(scene, 1);
  ExpectRight(outcome, 3);
  EXPECT_EQ(before.summary.given_up, 0);
  EXPECT_EQ(outcome.summary.given_up, 1);
}

TEST(FrameMatcher, CamerasThatOnlySayThatTheyHaveOneClock) {
  Scene scene = Offset();
  scene.shared = true;
  const Outcome outcome = Match(scene, 1);
  ExpectRight(outcome, 0);
  EXPECT_EQ(outcome.relation, ClockRelation::kEstimated);
}

TEST(FrameMatcher, DelaysThatShortenShowThatTheClocksWereMisjudged) {
  Scene scene = Offset();
  // All images of one camera come a period late at first: nothing shows it then.
  scene.cameras[1].late_by_ns = kPeriod;
  scene.cameras[1].late_until_ns = 3 * kSecond;
  const Outcome outcome = Match(scene, 1);
  ExpectAllGivenOnce(outcome);
  EXPECT_GE(outcome.summary.given_up, 1);
  EXPECT_LT(outcome.last_wrong_ns, 3 * kSecond + 100 * kMs);
  EXPECT_GT(outcome.pairs, outcome.possible - 30);
}

TEST(FrameMatcher, ADelayThatRisesForGoodIsNoOffsetOfTheClocks) {
  std::uint32_t seed = 0;
  for (const double rate_hz : {60.0, 200.0}) {
    for (const double periods : {-1.2, 0.3, 1.0, 1.2, 2.0}) {
      for (const std::int64_t until_s : {150, 999}) {
        Scene scene = Offset(rate_hz);
        scene.seconds = 200;
        scene.cameras[0].drift = 20e-6;
        const auto by_ns = static_cast<std::int64_t>(std::abs(periods) * 1e9 / rate_hz);
        scene.cameras[periods > 0 ? 1 : 0].detours.push_back(
            {20 * kSecond, until_s * kSecond, by_ns});
        const Outcome outcome = Match(scene, ++seed);
        SCOPED_TRACE(std::to_string(rate_hz) + " Hz, " + std::to_string(periods));
        ExpectRight(outcome, 10);
      }
    }
  }
}

TEST(FrameMatcher, OneImageThatTheHostDatesTooEarlyCostsNothing) {
  for (const std::int64_t by_ms : {3, 8, 12}) {
    Scene scene = Offset();
    scene.cameras[0].early_at_ns = 5 * kSecond;
    scene.cameras[0].early_by_ns = by_ms * kMs;
    scene.seconds = 60;
    const Outcome outcome = Match(scene, 2);
    ExpectRight(outcome, 1);
    EXPECT_EQ(outcome.summary.given_up, 0) << by_ms;
  }
}

TEST(FrameMatcher, OneClockThatIsNotIsSeenFromTensOfMilliseconds) {
  for (const std::int64_t periods : {-30, -10, -4, 4, 10, 30}) {
    Scene scene;
    scene.shared = true;
    scene.cameras[1].clock_ns = periods * kPeriod;
    const Outcome outcome = Match(scene, 1);
    ExpectRight(outcome, 0);
    EXPECT_EQ(outcome.relation, ClockRelation::kEstimated);
  }
}

TEST(FrameMatcher, OneClockThatIsSetInOneCameraAlone) {
  for (const std::int64_t periods : {-10, -2, -1, 1, 2, 10, 30}) {
    Scene scene;
    scene.shared = true;
    scene.cameras[1].clock_steps.push_back({4 * kSecond, periods * kPeriod});
    const Outcome outcome = Match(scene, 1);
    EXPECT_EQ(outcome.worst_ns, 0) << periods;
  }
}

TEST(NumberRule, StandsWhereClocksAndNumbersGoOnAsEver) {
  constexpr std::int64_t kStep = 1000;
  NumberRule rule;
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(rule.Judge(7, 20, kStep), NumberRule::Verdict::kKeeps);
  }
  EXPECT_EQ(rule.Judge(8, 20 + kStep, kStep), NumberRule::Verdict::kFirstDoubt);
  for (int i = 0; i < 100; ++i) {  // also where the clocks drift meanwhile
    EXPECT_EQ(rule.Judge(8, 20 + kStep + 10 * i, kStep), NumberRule::Verdict::kDoubt);
  }
  EXPECT_EQ(rule.Judge(7, 1020, kStep), NumberRule::Verdict::kKeeps);
}

TEST(NumberRule, ChangesWhereANumberIsMissingOrThePairsWereMisjudged) {
  constexpr std::int64_t kStep = 1000;
  for (const bool misjudged : {false, true}) {
    NumberRule rule;
    for (int i = 0; i < 100; ++i) rule.Judge(7, 20, kStep);
    if (misjudged) rule.Loosen();
    const std::int64_t apart_ns = misjudged ? 20 + kStep : 20;
    EXPECT_EQ(rule.Judge(8, apart_ns, kStep), NumberRule::Verdict::kFirstDoubt);
    for (int i = 0; i < 2; ++i) {
      EXPECT_EQ(rule.Judge(8, apart_ns, kStep), NumberRule::Verdict::kDoubt);
    }
    EXPECT_EQ(rule.Judge(8, apart_ns, kStep), NumberRule::Verdict::kKeeps);
  }
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

}  // namespace
}  // namespace stereomotion
