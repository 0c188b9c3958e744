#include "src/capture/live/pair_queue.h"

#include <gtest/gtest.h>

#include <atomic>
#include <set>
#include <thread>
#include <vector>

#include "simulated_camera.h"
#include "src/capture/live/frame_pool.h"

namespace stereomotion {
namespace {

using testing::kMs;

constexpr std::int64_t kImageBytes = 64 * 48;

std::shared_ptr<Frame> MakeFrame(FramePool& pool, std::int64_t index) {
  auto frame = pool.Take();
  frame->index = index;
  frame->timestamp_ns = index * 10 * kMs;
  testing::WriteInstant(index, 64, 48, frame->image);
  return frame;
}

void AddPairs(PairQueue& queue, FramePool& pool, std::int64_t from, std::int64_t to) {
  for (std::int64_t i = from; i < to; ++i)
    queue.Add(MakeFrame(pool, i), MakeFrame(pool, i), i * 10 * kMs);
}

TEST(PairQueue, DropsByTime) {
  FramePool pool;
  PairQueue queue({0.1, 1 << 30});
  AddPairs(queue, pool, 0, 100);
  queue.End();
  FramePair pair;
  for (std::int64_t i = 0; i < 100; ++i) {
    ASSERT_TRUE(queue.Read(i, pair));
    EXPECT_EQ(pair.left.index, i);
    EXPECT_EQ(pair.right.index, i);
    EXPECT_EQ(pair.left.timestamp_ns, i * 10 * kMs);
    const bool dropped = i >= kPairsKept && i < 89;
    EXPECT_EQ(pair.left.dropped, dropped) << i;
    EXPECT_EQ(pair.right.image.empty(), dropped) << i;
  }
  EXPECT_FALSE(queue.Read(100, pair));
  EXPECT_EQ(queue.dropped(), 89 - kPairsKept);
  EXPECT_EQ(queue.most_queued(), 11);
}

TEST(PairQueue, DropsByMemoryAndHoldsNoMore) {
  FramePool pool;
  PairQueue queue({1000, 10 * 2 * kImageBytes});
  AddPairs(queue, pool, 0, 1000);
  EXPECT_EQ(queue.dropped(), 1000 - kPairsKept - 10);
  EXPECT_LE(pool.made(), 2 * (kPairsKept + 12));
}

TEST(PairQueue, AnOrphanIsNoPair) {
  FramePool pool;
  PairQueue queue({0.01, 1 << 30});
  AddPairs(queue, pool, 0, kPairsKept);
  for (std::int64_t i = kPairsKept; i < kPairsKept + 5; ++i) {
    queue.Add(MakeFrame(pool, i), nullptr, i * 10 * kMs);
  }
  EXPECT_EQ(queue.dropped(), 0);  // no pair was dropped, but orphans were
  FramePair pair;
  ASSERT_TRUE(queue.Read(kPairsKept, pair));
  EXPECT_TRUE(pair.left.dropped);
  EXPECT_EQ(pair.right.index, -1);
  EXPECT_FALSE(pair.right.dropped);
  ASSERT_TRUE(queue.Read(kPairsKept + 4, pair));
  EXPECT_FALSE(pair.left.dropped);
  EXPECT_EQ(pair.right.index, -1);
  EXPECT_NE(pair.right.problem, "");
  EXPECT_TRUE(pair.right.image.empty());
}

TEST(PairQueue, SeveralReadersGetEveryPairOnce) {
  FramePool pool;
  PairQueue queue({1000, 1 << 30});
  constexpr std::int64_t kPairs = 500;  // a reader that is held up is not overtaken by more
  std::atomic<std::int64_t> next{0};
  std::array<std::set<std::int64_t>, 3> seen;
  std::vector<std::thread> readers;
  for (auto& mine : seen) {
    readers.emplace_back([&] {
      FramePair pair;
      for (std::int64_t at = next++; queue.Read(at, pair); at = next++) {
        if (!pair.right.image.empty() && testing::ReadInstant(pair.right.image) == at) {
          mine.insert(at);
        }
      }
    });
  }
  AddPairs(queue, pool, 0, kPairs);
  queue.End();
  for (std::thread& reader : readers) reader.join();
  EXPECT_EQ(seen[0].size() + seen[1].size() + seen[2].size(), static_cast<std::size_t>(kPairs));
}

TEST(FramePool, MemoryIsUsedAgain) {
  FramePool pool;
  const std::uint8_t* pixels = nullptr;
  for (int i = 0; i < 1000; ++i) {
    const auto frame = MakeFrame(pool, i);
    const std::shared_ptr<const Frame> another = frame;
    if (pixels == nullptr) pixels = frame->image.View().data;
    EXPECT_EQ(frame->image.View().data, pixels);
  }
  EXPECT_EQ(pool.made(), 1);
}

TEST(FramePool, FramesMayOutliveIt) {
  std::shared_ptr<Frame> frame;
  {
    FramePool pool;
    frame = MakeFrame(pool, 3);
  }
  EXPECT_EQ(frame->index, 3);
}

}  // namespace
}  // namespace stereomotion
