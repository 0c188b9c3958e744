#include "src/capture/aravis/frame_counter.h"

#include <gtest/gtest.h>

#include <vector>

namespace stereomotion {
namespace {

std::vector<std::int64_t> Unwrapped(const std::vector<std::uint64_t>& numbers) {
  FrameCounter counter;
  std::vector<std::int64_t> all;
  for (const std::uint64_t number : numbers) all.push_back(counter.Next(number));
  return all;
}

using Numbers = std::vector<std::int64_t>;

TEST(FrameCounter, GigeVisionSkipsZero) {
  EXPECT_EQ(Unwrapped({65534, 65535, 1, 2}), (Numbers{65534, 65535, 65536, 65537}));
  EXPECT_EQ(Unwrapped({65533, 2}), (Numbers{65533, 65537})) << "65534, 65535 and 1 are lost";
}

TEST(FrameCounter, SixteenBitsWithZero) {
  EXPECT_EQ(Unwrapped({65535, 0, 1}), (Numbers{65535, 65536, 65537}));
  EXPECT_EQ(Unwrapped({0, 65535, 1}), (Numbers{0, 65535, 65537})) << "0 is lost, and known to be";
}

TEST(FrameCounter, WrapsAgainAndAgain) {
  FrameCounter counter;
  std::int64_t expected = 1;
  for (int i = 0; i < 200000; ++i, ++expected) {
    const auto sent = static_cast<std::uint64_t>(i % 65535 + 1);
    ASSERT_EQ(counter.Next(sent), expected);
  }
  EXPECT_EQ(counter.restarts(), 0);
}

TEST(FrameCounter, LongerNumbers) {
  EXPECT_EQ(Unwrapped({65535, 65536, 65537}), (Numbers{65535, 65536, 65537}));
  constexpr std::uint64_t kLargest32 = 0xFFFFFFFF;
  EXPECT_EQ(Unwrapped({kLargest32, 1}), (Numbers{0xFFFFFFFF, 0x100000000}));
  constexpr std::uint64_t k64 = std::uint64_t{1} << 40;
  EXPECT_EQ(Unwrapped({k64, k64 + 3}), (Numbers{1LL << 40, (1LL << 40) + 3}));
}

TEST(FrameCounter, NumbersThatBeginAnewStillRise) {
  FrameCounter counter;
  EXPECT_EQ(counter.Next(5000), 5000);
  EXPECT_EQ(counter.Next(1), 5001);
  EXPECT_EQ(counter.Next(2), 5002);
  EXPECT_EQ(counter.restarts(), 1);
}

TEST(DeviceClock, WrapsAfter32BitsOfTicks) {
  DeviceClock clock(1'000'000'000);  // 4.29 s
  std::int64_t ns = 0;
  EXPECT_TRUE(clock.Next(4'294'000'000, ns));
  EXPECT_EQ(ns, 4'294'000'000);
  EXPECT_TRUE(clock.Next(1'000'000, ns));
  EXPECT_EQ(ns, 4'295'967'296);
  EXPECT_TRUE(clock.Next(2'000'000, ns));
  EXPECT_EQ(ns, 4'296'967'296);
}

TEST(DeviceClock, AStepBackIsTold) {
  DeviceClock clock(1'000'000'000);
  std::int64_t ns = 0;
  EXPECT_TRUE(clock.Next(90'000'000'000, ns));
  EXPECT_FALSE(clock.Next(1'000'000, ns));
  EXPECT_EQ(ns, 1'000'000);
  EXPECT_TRUE(clock.Next(2'000'000, ns));
}

TEST(DeviceClock, TimeThatStandsStillIsNoOtherClock) {
  DeviceClock clock(1'000'000'000);
  std::int64_t ns = 0;
  constexpr std::int64_t kWrapped = 4'294'967'296;
  EXPECT_TRUE(clock.Next(4'294'000'000, ns));
  EXPECT_TRUE(clock.Next(1'000'000, ns));
  for (const std::int64_t frozen : {1'000'000, 1'000'000, 999'999, 500'000, 1}) {
    EXPECT_TRUE(clock.Next(frozen, ns));
    EXPECT_EQ(ns, kWrapped + frozen) << "as it is, so that it is seen not to rise";
  }
  EXPECT_TRUE(clock.Next(20'000'000, ns));
  EXPECT_EQ(ns, kWrapped + 20'000'000);
}

TEST(DeviceClock, ManySmallStepsBackAreOneGreatOne) {
  DeviceClock clock;
  std::int64_t ns = 0;
  EXPECT_TRUE(clock.Next(90'000'000, ns));
  EXPECT_TRUE(clock.Next(89'500'000, ns));
  EXPECT_TRUE(clock.Next(89'000'000, ns));
  EXPECT_FALSE(clock.Next(88'500'000, ns));
}

}  // namespace
}  // namespace stereomotion
