#include "ordered_pairs.h"

#include <algorithm>

#include "stopwatch.h"

namespace stereomotion {
namespace {

void ReadAndDetect(const PairSource& source, std::int64_t position, BallDetector& left,
                   BallDetector& right, DetectedPair& pair) {
  Stopwatch watch;
  source.Read(position, pair.frames);
  pair.read_ms = watch.LapMs();
  pair.left.clear();
  pair.right.clear();
  if (!pair.frames.left.image.empty()) left.Detect(pair.frames.left.image.View(), pair.left);
  if (!pair.frames.right.image.empty()) right.Detect(pair.frames.right.image.View(), pair.right);
  pair.detect_ms = watch.LapMs();
}

}  // namespace

OrderedPairs::OrderedPairs(const PairSource& source, const Settings& settings)
    : source_(source),
      settings_(settings),
      slots_(static_cast<std::size_t>(2 * settings.threads + 2)),
      next_to_start_(settings.first),
      next_to_hand_out_(settings.first) {
  for (int i = 0; i < std::max(settings.threads, 1); ++i) workers_.emplace_back([this] { Work(); });
}

OrderedPairs::~OrderedPairs() { Stop(); }

void OrderedPairs::Stop() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void OrderedPairs::Work() {
  BallDetector left(settings_.noise_left, settings_.detection);
  BallDetector right(settings_.noise_right, settings_.detection);
  std::unique_lock<std::mutex> lock(mutex_);
  const auto capacity = static_cast<std::int64_t>(slots_.size());
  while (true) {
    changed_.wait(lock, [&] {
      return stop_ || next_to_start_ >= settings_.end ||
             next_to_start_ < next_to_hand_out_ + capacity;
    });
    if (stop_ || next_to_start_ >= settings_.end) return;
    const std::int64_t position = next_to_start_++;
    Slot& slot = SlotOf(position);
    lock.unlock();
    std::exception_ptr error;
    try {
      ReadAndDetect(source_, position, left, right, slot.pair);
    } catch (...) {
      error = std::current_exception();
    }
    lock.lock();
    if (error && !error_) error_ = error;
    slot.ready = true;
    changed_.notify_all();
  }
}

DetectedPair* OrderedPairs::Next() {
  std::unique_lock<std::mutex> lock(mutex_);
  if (handed_out_) {
    SlotOf(next_to_hand_out_).ready = false;
    ++next_to_hand_out_;
    handed_out_ = false;
    changed_.notify_all();
  }
  if (next_to_hand_out_ >= settings_.end) return nullptr;
  Slot& slot = SlotOf(next_to_hand_out_);
  changed_.wait(lock, [&] { return slot.ready || error_; });
  if (error_) std::rethrow_exception(error_);
  handed_out_ = true;
  return &slot.pair;
}

}  // namespace stereomotion
