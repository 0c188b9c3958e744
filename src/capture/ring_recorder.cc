#include "ring_recorder.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

#include "stereomotion/core/output_error.h"

namespace stereomotion {
namespace {

// A power cut may cost a second. What one call brings to the disk is believed once the next one has
// brought the note of it there: two of these times, and twice what a call lasts.
constexpr std::chrono::milliseconds kFlushEvery{250};

std::int64_t BytesOf(const Frame* frame) {
  if (frame == nullptr) return 0;
  const ImageView image = frame->image.View();
  return static_cast<std::int64_t>(image.width_px) * image.height_px *
         (image.type == PixelType::kGray8 ? 1 : 2);
}

std::int64_t BytesOf(const RingItem& item) {
  return BytesOf(item.frames[0].get()) + BytesOf(item.frames[1].get());
}

/// First in, first out; grows to its largest size and allocates no more.
class Ring {
 public:
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] std::int64_t size() const { return static_cast<std::int64_t>(size_); }
  void Push(RingItem item) {
    if (size_ == items_.size()) Grow();
    items_[(first_ + size_++) % items_.size()] = std::move(item);
  }
  RingItem Pop() {
    RingItem item = std::move(items_[first_]);
    first_ = (first_ + 1) % items_.size();
    --size_;
    return item;
  }

 private:
  void Grow() {
    constexpr std::size_t kFirstSize = 64;
    std::vector<RingItem> larger(std::max(kFirstSize, 2 * items_.size()));
    const std::size_t size = size_;
    for (std::size_t i = 0; i < size; ++i) larger[i] = Pop();
    items_ = std::move(larger);
    first_ = 0;
    size_ = size;
  }
  std::vector<RingItem> items_;
  std::size_t first_ = 0, size_ = 0;
};

class RingRecorder : public Recorder {
 public:
  RingRecorder(std::unique_ptr<FrameStore> store, std::int64_t ring_bytes)
      : store_(std::move(store)), ring_bytes_(ring_bytes) {
    for (int i = 0; i < store_->writers(); ++i) threads_.emplace_back([this] { WriteAll(); });
    threads_.emplace_back([this] { FlushAll(); });
  }
  ~RingRecorder() override { RingRecorder::Finish(); }

  void Take(const std::shared_ptr<const Frame>& left,
            const std::shared_ptr<const Frame>& right) override {
    RingItem item{{left, right}, -1};
    const std::int64_t bytes = BytesOf(item);
    {
      const std::lock_guard lock(mutex_);
      if (left && right) item.pair = pairs_taken_++;
      const bool fits = waiting_bytes_ == 0 || waiting_bytes_ + bytes <= ring_bytes_;
      if (finishing_ || !counts_.problem.empty() || !fits) {
        ++counts_.dropped;
        return;
      }
      waiting_bytes_ += bytes;
      ring_.Push(std::move(item));
    }
    changed_.notify_one();
  }

  void Finish() override {
    {
      const std::lock_guard lock(mutex_);
      if (finished_) return;
      finishing_ = finished_ = true;
    }
    changed_.notify_all();
    flush_.notify_all();
    for (std::thread& thread : threads_) thread.join();
    const bool failed = !counts().problem.empty();
    Guarded([&] { store_->Close(failed); });
  }

  RecorderCounts counts() const override {
    const std::lock_guard lock(mutex_);
    return counts_;
  }

 private:
  // The first problem is the one to tell.
  template <class Act>
  bool Guarded(const Act& act) {
    try {
      act();
      return true;
    } catch (const std::exception& error) {
      const std::lock_guard lock(mutex_);
      if (counts_.problem.empty()) counts_.problem = error.what();
      return false;
    }
  }

  void WriteAll() {
    RingItem item;
    RingPlace place;
    while (true) {
      bool done = false;
      {
        // Places are given in the order in which the frames came, whichever thread writes them.
        const std::lock_guard order(order_);
        if (!Next(item)) return;
        done = Guarded([&] { place = store_->Reserve(item); });
      }
      done = done && Guarded([&] { store_->Write(item, place); });
      place = {};
      Count(item, done);
    }
  }

  // False: all is written. Frames are never let go under the lock: their owner may wait for it.
  bool Next(RingItem& item) {
    Ring rest;
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return finishing_ || !ring_.empty(); });
    if (ring_.empty()) return false;
    if (counts_.problem.empty()) {
      item = ring_.Pop();
      return true;
    }
    std::swap(rest, ring_);  // after a failure nothing is written any more
    counts_.dropped += rest.size();
    waiting_bytes_ = 0;
    return false;
  }

  void Count(RingItem& item, bool done) {
    const std::int64_t bytes = BytesOf(item);
    const RingItem let_go = std::move(item);
    const std::lock_guard lock(mutex_);
    if (done) {
      for (std::size_t i = 0; i < 2; ++i) counts_.frames[i] += let_go.frames[i] ? 1 : 0;
      counts_.pairs += let_go.pair >= 0 ? 1 : 0;
      counts_.bytes += bytes;
    } else {
      ++counts_.dropped;
    }
    waiting_bytes_ = std::max<std::int64_t>(waiting_bytes_ - bytes, 0);
  }

  void FlushAll() {
    std::unique_lock lock(mutex_);
    while (!flush_.wait_for(lock, kFlushEvery, [&] { return finishing_; })) {
      if (!counts_.problem.empty()) continue;
      lock.unlock();
      Guarded([&] { store_->Flush(); });
      lock.lock();
    }
  }

  std::unique_ptr<FrameStore> store_;
  const std::int64_t ring_bytes_;
  std::mutex order_;  // taken before `mutex_`
  mutable std::mutex mutex_;
  std::condition_variable changed_, flush_;
  Ring ring_;
  std::int64_t waiting_bytes_ = 0, pairs_taken_ = 0;
  bool finishing_ = false, finished_ = false;
  RecorderCounts counts_;
  std::vector<std::thread> threads_;
};

}  // namespace

std::unique_ptr<Recorder> MakeRingRecorder(std::unique_ptr<FrameStore> store,
                                           std::int64_t ring_bytes) {
  return std::make_unique<RingRecorder>(std::move(store), ring_bytes);
}

}  // namespace stereomotion
