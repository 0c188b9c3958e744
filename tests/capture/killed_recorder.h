#pragma once

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <random>
#include <thread>

#include "recorded_frames.h"
#include "stereomotion/capture/recorder.h"
#include "stereomotion/capture/recording.h"
#include "temporary_folder.h"
#include "tests/support/test_rng.h"

namespace stereomotion::testing {

constexpr std::int64_t kKilledPairsASecond = 200;
constexpr int kKilledWidth_px = 320, kKilledHeight_px = 240;

/// Counts what the killed process handed to its recorder.
class SharedCounter {
 public:
  SharedCounter()
      : count_(static_cast<std::atomic<std::int64_t>*>(mmap(
            nullptr, sizeof(*count_), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0))) {
  }
  ~SharedCounter() { munmap(count_, sizeof(*count_)); }
  SharedCounter(const SharedCounter&) = delete;
  SharedCounter& operator=(const SharedCounter&) = delete;
  std::atomic<std::int64_t>& operator*() { return *count_; }

 private:
  std::atomic<std::int64_t>* count_;
};

/// What the killed process does.
[[noreturn]] inline void RecordForEver(const std::filesystem::path& output,
                                       std::atomic<std::int64_t>& taken) {
  const auto recorder = StartRecorder({output});
  auto next = std::chrono::steady_clock::now();
  while (true) {
    const std::int64_t i = taken;
    recorder->Take(MakeFrame(0, i, PixelType::kGray8, kKilledWidth_px, kKilledHeight_px),
                   MakeFrame(1, i, PixelType::kGray8, kKilledWidth_px, kKilledHeight_px));
    ++taken;
    next += std::chrono::microseconds(1'000'000 / kKilledPairsASecond);
    std::this_thread::sleep_until(next);
  }
}

/// Records for so long in a process of its own and kills it; returns the pairs that it took.
inline std::int64_t RecordAndKill(const std::filesystem::path& output,
                                  std::chrono::milliseconds after) {
  SharedCounter taken;
  const pid_t child = fork();
  if (child == 0) RecordForEver(output, *taken);
  while (*taken == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  std::this_thread::sleep_for(after);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  return *taken;
}

/// Reads all pairs: each must be whole, and they must be the first ones that were taken.
inline std::int64_t CountWholePairs(const std::filesystem::path& left,
                                    const std::filesystem::path& right) {
  const auto recording = OpenRecording(left, right);
  FramePair pair;
  std::int64_t pairs = 0;
  for (std::int64_t i = 0; i < recording->size(); ++i) {
    recording->Read(i, pair);
    EXPECT_EQ(pair.left.problem, "");
    const auto sees = [&](const Frame& frame, int camera) {
      const auto taken =
          MakeFrame(camera, pair.left.index, PixelType::kGray8, kKilledWidth_px, kKilledHeight_px);
      return SameImage(frame.image.View(), taken->image.View());
    };
    EXPECT_TRUE(sees(pair.left, 0)) << "torn left image " << pair.left.index;
    if (pair.right.index < 0) continue;
    EXPECT_TRUE(sees(pair.right, 1)) << "torn right image " << pair.right.index;
    ++pairs;
  }
  return pairs;
}

/// Kills recorders at random moments: each recording must be whole but for its last second.
inline void KillAndRepair(int times) {
  auto rng = MakeTestRng();
  for (int i = 0; i < times; ++i) {
    TemporaryFolder folder;
    const auto file = folder.path() / "rec.h5";
    const std::chrono::milliseconds after(std::uniform_int_distribution<int>(0, 1500)(rng));
    const std::int64_t taken = RecordAndKill(file, after);
    ASSERT_TRUE(NeedsRepair(file));
    if (i % 2 == 0) RepairRecording(file);  // else opening does it
    if (taken <= kKilledPairsASecond && RepairRecording(file).frames[1] == 0) continue;
    const std::int64_t pairs = CountWholePairs(file.string() + ":cam0", file.string() + ":cam1");
    EXPECT_GE(pairs, taken - kKilledPairsASecond) << "more than a second is lost";
    EXPECT_FALSE(NeedsRepair(file));
  }
}

}  // namespace stereomotion::testing
