#include "stereomotion/capture/live_pairs.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>
#include <stdexcept>
#include <thread>

#include "fake_camera.h"

namespace {
std::atomic<std::int64_t> allocations{0};
}  // namespace

// Counts what is allocated, for the test that a frame costs none.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace stereomotion {
namespace {

using testing::FakeCamera;
using testing::kMs;
using testing::kSecond;
using testing::ReadInstant;
using testing::Simulate;
using testing::SimulatedCamera;
using Clock = std::chrono::steady_clock;

constexpr double kRateHz = 200;

/// Keeps what the tap is shown.
class Tap : public FrameTap {
 public:
  void Take(const std::shared_ptr<const Frame>& left,
            const std::shared_ptr<const Frame>& right) override {
    pairs += left && right ? 1 : 0;
    alone[0] += left && !right ? 1 : 0;
    alone[1] += !left && right ? 1 : 0;
    if (fails_at >= 0 && pairs == fails_at) throw std::runtime_error("tap: no room");
  }
  std::int64_t pairs = 0, fails_at = -1;
  std::array<std::int64_t, 2> alone{};
};

struct Scene {
  std::array<SimulatedCamera, 2> cameras;
  double seconds = 1;
  FakeCamera::Options device;
  LiveOptions options;

  Scene() {
    for (SimulatedCamera& camera : cameras) camera.period_ns = 1e9 / kRateHz;
    cameras[1].clock_ns = 4000 * kSecond;
  }
  std::array<std::vector<Clock::time_point>, 2> triggered;

  std::unique_ptr<LivePairs> Open(FrameTap* tap = nullptr) {
    std::array<std::unique_ptr<CameraDevice>, 2> devices;
    device.zero = Clock::now() + std::chrono::milliseconds(20);
    for (int i = 0; i < 2; ++i) {
      device.triggered = &triggered[static_cast<std::size_t>(i)];
      device.uri = i == 0 ? "fake:left" : "fake:right";
      auto frames = Simulate(cameras[static_cast<std::size_t>(i)], i, seconds, 1);
      devices[static_cast<std::size_t>(i)] =
          std::make_unique<FakeCamera>(device, std::move(frames));
    }
    return std::make_unique<LivePairs>(std::move(devices[0]), std::move(devices[1]), options, tap);
  }
};

/// What a reader saw of a stream.
struct Seen {
  std::int64_t rows = 0, pairs = 0, alone = 0, dropped = 0, wrong = 0;
  bool rises = true;
};

void Look(const FramePair& pair, std::int64_t& last_ns, Seen& seen) {
  ++seen.rows;
  seen.rises = seen.rises && (seen.rows == 1 || pair.left.timestamp_ns > last_ns);
  last_ns = pair.left.timestamp_ns;
  if (pair.left.dropped) {
    ++seen.dropped;
    EXPECT_TRUE(pair.left.image.empty());
    EXPECT_NE(pair.left.problem, "");
  } else if (pair.right.index < 0) {
    ++seen.alone;
    EXPECT_FALSE(pair.left.image.empty());
  } else {
    ++seen.pairs;
    seen.wrong += ReadInstant(pair.left.image) != ReadInstant(pair.right.image) ? 1 : 0;
  }
}

Seen ReadAll(const LivePairs& live, std::chrono::milliseconds each = {}) {
  Seen seen;
  FramePair pair;
  std::int64_t last_ns = 0;
  for (std::int64_t at = 0; live.Read(at, pair); ++at) {
    Look(pair, last_ns, seen);
    std::this_thread::sleep_for(each);
  }
  EXPECT_EQ(seen.wrong, 0);
  EXPECT_TRUE(seen.rises);
  return seen;
}

TEST(LivePairs, DeliversSoManyPairsAndEnds) {
  Scene scene;
  scene.options.count = 100;
  scene.cameras[0].lost = scene.cameras[1].lost = 0.05;
  Tap tap;
  const auto live = scene.Open(&tap);
  live->Start();
  const Seen seen = ReadAll(*live);
  EXPECT_EQ(seen.pairs, 100);
  EXPECT_EQ(tap.pairs, 100);
  EXPECT_EQ(tap.alone[0], seen.alone);
  EXPECT_GT(seen.alone, 0);
  const LiveReport report = live->report();
  EXPECT_EQ(report.end, "count");
  EXPECT_EQ(report.problem, "");
  EXPECT_EQ(report.pairs, 100);
  EXPECT_NEAR(report.clock_offset_s, 4000, 0.01);
  EXPECT_NEAR(report.period_s, 1 / kRateHz, 1e-4);
  EXPECT_FALSE(report.free_running);
}

TEST(LivePairs, TheHostTimeOfAnImageIsItsTrueTimeAndTheShortestDelay) {
  Scene scene;
  scene.options.count = 50;
  const auto live = scene.Open();
  live->Start();
  FramePair pair;
  ASSERT_TRUE(live->Read(20, pair));
  const auto zero_ns = std::chrono::nanoseconds(scene.device.zero.time_since_epoch()).count();
  const std::int64_t true_ns = zero_ns + ReadInstant(pair.left.image);
  const std::int64_t late_ns = live->HostTimeOf(pair.left.timestamp_ns, 0) - true_ns;
  EXPECT_NEAR(static_cast<double>(late_ns - scene.cameras[0].delay_ns), 0, 0.5 * kMs);
}

TEST(LivePairs, DropsTheOldestWhereMeasuringIsTooSlow) {
  Scene scene;
  scene.options.queue_s = 0.1;
  scene.options.duration_s = 1;
  Tap tap;
  const auto live = scene.Open(&tap);
  live->Start();
  const Seen seen = ReadAll(*live, std::chrono::milliseconds(15));
  EXPECT_EQ(seen.rows, tap.pairs + tap.alone[0]);  // every one has its row
  EXPECT_GT(seen.dropped, 10);
  const LiveReport report = live->report();
  EXPECT_EQ(report.dropped_pairs, seen.dropped);
  EXPECT_LT(report.most_queued, 100);  // 20, but for a busy machine; PairQueue has the exact test
  EXPECT_EQ(report.end, "duration");
}

TEST(LivePairs, TheFirstPairsCanBeReadAgain) {
  Scene scene;
  scene.options.queue_s = 0.05;
  const auto live = scene.Open();
  live->Start();
  FramePair pair, again;
  for (std::int64_t at = 0; at < kPairsKept; ++at) ASSERT_TRUE(live->Read(at, pair));
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  for (std::int64_t at = 0; at < kPairsKept; ++at) {
    ASSERT_TRUE(live->Read(at, again));
    ASSERT_FALSE(again.left.dropped);
    EXPECT_EQ(again.left.index, at);
  }
  EXPECT_EQ(again.left.timestamp_ns, pair.left.timestamp_ns);
  live->Stop("interrupted");
}

TEST(LivePairs, ALostCameraComesBackAndTheOtherGoesOn) {
  for (const std::size_t lost : {0U, 1U}) {
    Scene scene;
    scene.seconds = 2.5;
    scene.cameras[lost].outages.push_back({800 * kMs, 500 * kMs, 99 * kSecond});
    scene.options.duration_s = 2.4;
    Tap tap;
    const auto live = scene.Open(&tap);
    live->Start();
    const Seen seen = ReadAll(*live);
    const LiveReport report = live->report();
    EXPECT_EQ(report.end, "duration");
    EXPECT_EQ(report.cameras[lost].counts.reopened, 1);
    EXPECT_GT(report.cameras[lost].down_s, 0.2);
    EXPECT_GT(seen.pairs, 200) << lost;
    EXPECT_GT(tap.alone[1 - lost], 50) << lost;  // while the other was away
  }
}

TEST(LivePairs, ACameraThatStaysAwayEndsTheRunWithAReason) {
  Scene scene;
  scene.seconds = 2;
  scene.cameras[1].outages.push_back({300 * kMs, 1000 * kMs, 0});
  scene.device.comes_back = false;
  std::atomic<int> tries{0};
  scene.device.opened = &tries;
  scene.options.reconnect_s = 0.8;
  const auto live = scene.Open();
  live->Start();
  const Seen seen = ReadAll(*live);
  EXPECT_GT(seen.pairs, 30);
  const LiveReport report = live->report();
  EXPECT_EQ(report.end, "camera_lost");
  EXPECT_NE(report.problem.find("fake:right: lost"), std::string::npos) << report.problem;
  EXPECT_NE(report.problem.find("no answer"), std::string::npos) << report.problem;
  EXPECT_GE(tries, 2);
  EXPECT_LE(tries, 4);  // with growing pauses
}

TEST(LivePairs, ACameraThatAnswersButSendsNothingIsOpenedAgain) {
  Scene scene;
  scene.cameras[1].outages.push_back({300 * kMs, 100 * kMs, 0});
  std::atomic<int> tries{0};
  scene.device.opened = &tries;
  scene.device.mute_after_ns = 400 * kMs;
  scene.options.first_image_s = 0.3;
  scene.options.reconnect_s = 1;
  const auto live = scene.Open();
  live->Start();
  ReadAll(*live);
  const LiveReport report = live->report();
  EXPECT_EQ(report.end, "camera_lost");
  EXPECT_NE(report.problem.find("sent no image"), std::string::npos) << report.problem;
  EXPECT_GE(tries, 2);
}

TEST(LivePairs, NoImageEndsTheRunWithAReason) {
  Scene scene;
  scene.cameras[0].lost = 1;
  scene.options.first_image_s = 0.3;
  const auto live = scene.Open();
  live->Start();
  EXPECT_EQ(ReadAll(*live).rows, 0);
  const LiveReport report = live->report();
  EXPECT_EQ(report.end, "no_images");
  EXPECT_NE(report.problem.find("fake:left"), std::string::npos);
  EXPECT_NE(report.problem.find("trigger"), std::string::npos);
}

TEST(LivePairs, StopEndsAReadThatWaits) {
  Scene scene;
  scene.seconds = 0.2;
  const auto live = scene.Open();
  live->Start();
  std::thread stopper([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(400));
    live->Stop("interrupted");
  });
  EXPECT_GT(ReadAll(*live).pairs, 30);
  stopper.join();
  EXPECT_EQ(live->report().end, "interrupted");
}

TEST(LivePairs, NeverStarted) {
  Scene scene;
  const auto live = scene.Open();
  EXPECT_EQ(live->report().pairs, 0);
  live->Stop("interrupted");
  FramePair pair;
  EXPECT_FALSE(live->Read(0, pair));
}

TEST(LivePairs, AFailingTapEndsTheRun) {
  Scene scene;
  Tap tap;
  tap.fails_at = 20;
  const auto live = scene.Open(&tap);
  live->Start();
  EXPECT_EQ(ReadAll(*live).pairs, 19);
  EXPECT_EQ(live->report().end, "error");
  EXPECT_EQ(live->report().problem, "tap: no room");
}

TEST(LivePairs, SendsTriggersToBoth) {
  Scene scene;
  std::atomic<int> triggers{0};
  scene.device.triggers = &triggers;
  scene.options.trigger_hz = 100;
  scene.options.duration_s = 0.5;
  const auto live = scene.Open();
  live->Start();
  ReadAll(*live);
  EXPECT_GT(triggers, 30);  // 50 each; a busy machine misses some
  EXPECT_LE(triggers, 2 * 56);
}

TEST(LivePairs, TriggersGoOutTogetherAgainAfterAnOutage) {
  using std::chrono::milliseconds;
  Scene scene;
  scene.seconds = 2;
  scene.cameras[1].outages.push_back({330 * kMs, 150 * kMs, 0});
  scene.options.trigger_hz = 10;
  scene.options.duration_s = 1.6;
  const auto live = scene.Open();
  live->Start();
  ReadAll(*live);
  const auto &left = scene.triggered[0], &right = scene.triggered[1];
  ASSERT_GT(left.size(), 10U);
  ASSERT_GT(right.size(), 5U);
  Clock::duration nearest = milliseconds(100);
  for (std::size_t i = 1; i <= 5; ++i) {  // a busy machine delays some
    auto apart = (right[right.size() - i] - left[left.size() - i]) % milliseconds(100);
    if (apart < Clock::duration(0)) apart += milliseconds(100);
    nearest = std::min({nearest, apart, milliseconds(100) - apart});
  }
  EXPECT_LT(nearest, milliseconds(20));
}

TEST(LivePairs, AFrameCostsNoAllocation) {
  Scene scene;
  scene.seconds = 2;
  const auto live = scene.Open();
  live->Start();
  FramePair pair;
  std::int64_t at = 0;
  for (; at < 150; ++at) ASSERT_TRUE(live->Read(at, pair));
  const std::int64_t before = allocations;
  for (; at < 350; ++at) ASSERT_TRUE(live->Read(at, pair));
  // What the cameras say of themselves is copied twice a second; a frame would cost 200 at least.
  EXPECT_LT(allocations - before, 100);
  live->Stop("interrupted");
}

}  // namespace
}  // namespace stereomotion
