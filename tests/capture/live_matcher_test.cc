#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "matcher_run.h"

namespace stereomotion {
namespace {

using testing::ExpectRight;
using testing::kMs;
using testing::kPeriod;
using testing::kSecond;
using testing::Match;
using testing::Offset;
using testing::Outcome;
using testing::Scene;
using testing::SimulatedCamera;

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

// The second camera sends each image a period or more later than the first: arrivals alone would
// take neighbours for partners, the times that coincide tell the truth.
TEST(FrameMatcher, TimesThatCoincideOutweighArrivals) {
  for (const double periods : {0.4, 1.0, 1.3, 2.0, 7.0}) {
    for (std::uint32_t seed = 0; seed < 5; ++seed) {
      Scene scene;
      scene.cameras[1].delay_ns += std::llround(periods * kPeriod);
      const Outcome outcome = Match(scene, seed);
      ExpectRight(outcome, 0);
      EXPECT_EQ(outcome.relation, ClockRelation::kAgreeing);
      EXPECT_FALSE(outcome.free_running);
    }
  }
}

// A recording that is played faster or slower than it was taken.
TEST(FrameMatcher, TimesThatCoincideNeedNoTrueClocks) {
  for (const double drift : {-0.5, 1.0}) {
    Scene scene;
    for (auto& camera : scene.cameras) camera.drift = drift;
    ExpectRight(Match(scene, 1), 0);
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

TEST(FrameMatcher, ATriggerByCommandJitters) {
  for (std::uint32_t seed = 0; seed < 10; ++seed) {
    Scene scene = Offset(20);
    for (SimulatedCamera& camera : scene.cameras) camera.stamp_jitter_ns = 2e6;
    ExpectRight(Match(scene, seed), 40);  // of 200: it takes longer until the clocks are known
  }
}

TEST(FrameMatcher, ImagesThatCarryTheTimeOfTheirArrival) {
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    Scene scene;
    std::mt19937 random(seed);
    for (SimulatedCamera& camera : scene.cameras) {
      camera.stamps_arrival = true;
      camera.lost = 0.05;
      for (std::int64_t at_ns = kSecond; at_ns < 10 * kSecond; at_ns += (random() % 1500) * kMs) {
        camera.stalls.push_back({at_ns, static_cast<std::int64_t>(random() % 60) * kMs});
      }
    }
    const Outcome outcome = Match(scene, seed);
    EXPECT_EQ(outcome.worst_ns, 0) << seed;
    EXPECT_GT(outcome.pairs, outcome.possible * 8 / 10) << seed;
  }
}

TEST(FrameMatcher, ASlowRate) {
  Scene scene = Offset(1);
  scene.seconds = 30;
  ExpectRight(Match(scene, 1), 0);
}

TEST(FrameMatcher, ATighterToleranceTakesFewerPairs) {
  Scene scene;
  scene.shared = true;
  scene.cameras[1].phase_ns = 2 * kMs;
  EXPECT_EQ(Match(scene, 1).pairs, Match(scene, 1).left);
  scene.tolerance_ns = kMs;
  const Outcome outcome = Match(scene, 1);
  EXPECT_EQ(outcome.pairs, 0);
  EXPECT_NEAR(outcome.summary.phase_ns, 2e6, 1e4);
}

/// Feeds the times [ms] of one clock; returns the pairs as "left-right".
std::vector<std::string> MatchTimes(const std::vector<double>& left_ms,
                                    const std::vector<double>& right_ms, double tolerance_ms) {
  std::vector<std::string> pairs;
  const auto number = [](const Frame& frame) { return std::to_string(frame.device_ns / kMs); };
  FrameMatcher matcher({std::llround(tolerance_ms * kMs), 512},
                       [&](const auto& left, const auto& right) {
                         if (left && right) pairs.push_back(number(*left) + "-" + number(*right));
                       });
  matcher.TakeOneClock();
  std::vector<std::pair<double, int>> all;
  for (const double ms : left_ms) all.emplace_back(ms, 0);
  for (const double ms : right_ms) all.emplace_back(ms, 1);
  std::sort(all.begin(), all.end());
  std::int64_t id = 0;
  for (const auto& [ms, camera] : all) {
    const std::int64_t ns = std::llround(ms * kMs);
    matcher.Take(camera, {std::make_shared<Frame>(), id++, ns, ns, 0});
    matcher.Advance(ns);
  }
  matcher.Finish();
  return pairs;
}

TEST(FrameMatcher, OfTwoPossiblePartnersTheNearestByFarIsTaken) {
  std::vector<double> left, right;
  for (int i = 1; i <= 10; ++i) {
    left.push_back(100 * i);
    right.push_back(100 * i + 1);
  }
  ASSERT_EQ(MatchTimes(left, right, 20).size(), 10U);
  auto close = right;
  close[5] = 590;  // of 590 and 609 neither is nearer by far
  close.insert(close.begin() + 6, 609);
  EXPECT_EQ(MatchTimes(left, close, 20).size(), 9U);
  close[6] = 602;  // but 602 is
  const auto pairs = MatchTimes(left, close, 20);
  EXPECT_EQ(pairs.size(), 10U);
  EXPECT_EQ(std::count(pairs.begin(), pairs.end(), "600-602"), 1);
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
