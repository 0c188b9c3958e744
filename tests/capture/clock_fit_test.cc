#include "src/capture/live/clock_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "simulated_camera.h"

namespace stereomotion {
namespace {

using testing::kMs;
using testing::kSecond;

/// A camera at `period` whose clock is `offset` ahead of the host's and gains `drift`.
struct Source {
  std::int64_t period_ns = 16'666'667;
  std::int64_t offset_ns = 7200 * kSecond + 12'345;
  double drift = 0;
  double jitter_ns = 300'000;  ///< mean of the delay besides the shortest one, which is zero here

  void Feed(ClockFit& fit, std::int64_t from, std::int64_t to, std::mt19937_64& random,
            std::int64_t stalled_until = 0) const {
    std::exponential_distribution<double> delay;
    for (std::int64_t k = from; k < to; ++k) {
      const std::int64_t at_ns = k * period_ns;
      const auto late_ns = static_cast<std::int64_t>(jitter_ns * delay(random));
      fit.Add(Device(at_ns), std::max(at_ns + late_ns, stalled_until * period_ns));
    }
  }
  [[nodiscard]] std::int64_t Device(std::int64_t at_ns) const {
    return at_ns + offset_ns + std::llround(drift * static_cast<double>(at_ns));
  }
  /// How far the fit lies from the truth at a time.
  [[nodiscard]] double ErrorNs(const ClockFit& fit, std::int64_t k) const {
    const std::int64_t at_ns = k * period_ns, device_ns = Device(at_ns);
    return static_cast<double>(device_ns + fit.line().HostMinusDevice(device_ns) - at_ns);
  }
};

TEST(ClockFit, ExactArrivals) {
  Source source;
  source.jitter_ns = 0;
  ClockFit fit;
  std::mt19937_64 random(1);
  EXPECT_FALSE(fit.has_line());
  source.Feed(fit, 0, 2, random);
  EXPECT_TRUE(std::isinf(fit.uncertainty_ns()));
  source.Feed(fit, 2, 8, random);
  EXPECT_LT(std::abs(source.ErrorNs(fit, 7)), 2);
  EXPECT_LT(fit.uncertainty_ns(), 2);
}

TEST(ClockFit, TheUncertaintyShrinksAndHoldsTheError) {
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    const Source source;
    ClockFit fit;
    std::mt19937_64 random(seed);
    double before_ns = 1e18;
    for (const std::int64_t frames : {8, 64, 512, 4096}) {
      source.Feed(fit, fit.frames(), frames, random);
      // Of eight images four may agree by chance.
      const double bound_ns = frames == 8 ? 300'000 : 5 * fit.uncertainty_ns();
      EXPECT_LT(std::abs(source.ErrorNs(fit, frames)), bound_ns) << frames;
      // More points must agree from the 32nd on, so it need not shrink there.
      EXPECT_LT(fit.uncertainty_ns(), frames == 64 ? 1e9 : before_ns);
      before_ns = fit.uncertainty_ns();
    }
    EXPECT_LT(before_ns, 30'000);
  }
}

TEST(ClockFit, Drift) {
  for (const double drift : {-200e-6, 100e-6}) {
    Source source;
    source.drift = drift;
    ClockFit fit;
    std::mt19937_64 random(3);
    source.Feed(fit, 0, 60 * 60, random);
    EXPECT_NEAR(fit.line().slope, -drift, 2e-6);
    EXPECT_LT(fit.slope_uncertainty(), 5e-6);
    EXPECT_LT(std::abs(source.ErrorNs(fit, 60 * 60)), 30'000);
  }
}

TEST(ClockFit, ABurstOfDelayedArrivalsDoesNotFoolIt) {
  for (std::int64_t burst = 2; burst < 60; burst += 3) {
    const Source source;
    ClockFit fit;
    std::mt19937_64 random(5);
    source.Feed(fit, 0, burst, random, burst);  // from the very first image on
    // Either it says that it does not know, or it knows.
    if (fit.uncertainty_ns() < 5 * kMs) {
      EXPECT_LT(source.ErrorNs(fit, burst), 5 * kMs) << burst;
    }
    source.Feed(fit, burst, 300, random);
    EXPECT_LT(std::abs(source.ErrorNs(fit, 300)), 100'000) << burst;
    source.Feed(fit, 300, 400, random, 400);  // and in the middle
    EXPECT_LT(std::abs(source.ErrorNs(fit, 400)), 200'000) << burst;
  }
}

TEST(ClockFit, FollowsAClockThatWarmsUp) {
  Source source;
  ClockFit fit;
  std::mt19937_64 random(7);
  source.Feed(fit, 0, 60 * 600, random);  // ten minutes at one rate
  Source warm = source;
  warm.drift = 20e-6;
  warm.offset_ns -= std::llround(20e-6 * 60 * 600 * 16'666'667.0);
  warm.Feed(fit, 60 * 600, 60 * 800, random);
  EXPECT_LT(std::abs(warm.ErrorNs(fit, 60 * 800)), 50'000);
  EXPECT_NEAR(fit.line().slope, -20e-6, 2e-6);
}

TEST(ClockFit, ALoneEarlyArrivalIsLeftOut) {
  for (const std::int64_t early_ms : {3, 50, 500}) {
    const Source source;
    ClockFit fit;
    std::mt19937_64 random(11);
    source.Feed(fit, 0, 600, random);
    const std::int64_t at_ns = 600 * source.period_ns;
    fit.Add(source.Device(at_ns), at_ns - early_ms * kMs);
    for (std::int64_t k = 601; k < 60 * 30; k += 60) {
      EXPECT_LT(std::abs(source.ErrorNs(fit, k)), 100'000) << k;
      EXPECT_LT(fit.uncertainty_ns(), 300'000) << k;
      source.Feed(fit, k, k + 60, random);
    }
  }
}

TEST(ClockFit, AShortestDelayThatRisesForGoodIsTakenOff) {
  const Source source;
  ClockFit fit;
  std::mt19937_64 random(13);
  const auto feed_late = [&](std::int64_t from, std::int64_t to, std::int64_t late_ns) {
    for (std::int64_t k = from; k < to; ++k) {
      const std::int64_t at_ns = k * source.period_ns;
      fit.Add(source.Device(at_ns),
              at_ns + late_ns + static_cast<std::int64_t>(random() % 300'000));
      if (k % 60 != 0) continue;
      EXPECT_LT(std::abs(source.ErrorNs(fit, k)), 200'000) << k;
    }
  };
  source.Feed(fit, 0, 60 * 30, random);
  feed_late(60 * 30, 60 * 200, 17 * kMs);
  feed_late(60 * 200, 60 * 300, 0);  // and it may fall again
}

TEST(ClockFit, ResetForgets) {
  Source source;
  ClockFit fit;
  std::mt19937_64 random(9);
  source.Feed(fit, 0, 500, random);
  fit.Reset();
  EXPECT_TRUE(fit.has_line());
  source.offset_ns = 5;
  source.Feed(fit, 500, 600, random);
  EXPECT_LT(std::abs(source.ErrorNs(fit, 600)), 100'000);
  EXPECT_EQ(fit.frames(), 100);
}

}  // namespace
}  // namespace stereomotion
