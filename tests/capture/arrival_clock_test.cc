#include "src/capture/aravis/arrival_clock.h"

#include <gtest/gtest.h>

namespace stereomotion {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kWall = 1'700'000'000'000 * kMs;  // wall clock at monotonic 0

/// A computer whose wall clock is set now and then.
struct Computer {
  std::int64_t set_by_ns = 0;
  std::int64_t WallAt(std::int64_t monotonic_ns) const { return kWall + monotonic_ns + set_by_ns; }
  Moment At(std::int64_t monotonic_ns) const { return {WallAt(monotonic_ns), monotonic_ns}; }
};

TEST(ArrivalClock, ClocksThatAgreeTranslateExactly) {
  const Computer computer;
  ArrivalClock clock(computer.At(0));
  EXPECT_EQ(clock.MonotonicNs(computer.WallAt(100 * kMs), computer.At(130 * kMs)), 100 * kMs);
  EXPECT_EQ(clock.MonotonicNs(computer.WallAt(120 * kMs), computer.At(131 * kMs)), 120 * kMs);
}

TEST(ArrivalClock, ImagesThatWaitedWhileTheClockWasSetAreNeverTooEarly) {
  for (const std::int64_t step_ns : {-3600'000 * kMs, -20 * kMs, 3 * kMs, 50 * kMs, 500 * kMs}) {
    Computer computer;
    ArrivalClock clock(computer.At(0));
    const std::int64_t first = computer.WallAt(1000 * kMs);
    const std::int64_t second = computer.WallAt(1016 * kMs);
    computer.set_by_ns = step_ns;  // both images wait to be taken
    EXPECT_EQ(clock.MonotonicNs(first, computer.At(1020 * kMs)), 1020 * kMs) << step_ns;
    EXPECT_GE(clock.MonotonicNs(second, computer.At(1021 * kMs)), 1016 * kMs) << step_ns;
    EXPECT_EQ(clock.MonotonicNs(computer.WallAt(1033 * kMs), computer.At(1040 * kMs)), 1033 * kMs)
        << "exact again after " << step_ns;
  }
}

TEST(ArrivalClock, SlewingIsFollowed) {
  Computer computer;
  ArrivalClock clock(computer.At(0));
  for (std::int64_t now_ns = 0; now_ns < 10'000 * kMs; now_ns += 16 * kMs) {
    computer.set_by_ns = now_ns / 2000;  // 500 ppm, the most that NTP does
    const std::int64_t waited_ns = now_ns > 0 ? 5 * kMs : 0;
    EXPECT_EQ(clock.MonotonicNs(computer.WallAt(now_ns - waited_ns), computer.At(now_ns)),
              now_ns - waited_ns);
  }
}

TEST(ArrivalClock, NothingComesInTheFuture) {
  const Computer computer;
  ArrivalClock clock(computer.At(0));
  EXPECT_EQ(clock.MonotonicNs(computer.WallAt(50 * kMs), computer.At(40 * kMs)), 40 * kMs);
}

}  // namespace
}  // namespace stereomotion
