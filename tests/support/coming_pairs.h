#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include "stereomotion/core/pair_source.h"

namespace stereomotion::testing {

/// Delivers pairs as they "come", and holds its reader to the rules of `PairSource`.
class ComingPairs : public PairSource {
 public:
  explicit ComingPairs(std::vector<FramePair> pairs) : pairs_(std::move(pairs)) {}
  [[nodiscard]] std::int64_t size() const override { return kEndlessSource; }
  bool Read(std::int64_t position, FramePair& pair) const override {
    std::unique_lock<std::mutex> lock(mutex_);
    came_.wait(lock, [&] { return position < there_ || ended_; });
    if (position >= there_) return false;
    CheckRules(position);
    pair = pairs_[static_cast<std::size_t>(position)];
    return true;
  }
  void LetCome(std::int64_t pairs) {
    const std::lock_guard<std::mutex> lock(mutex_);
    there_ = pairs;
    came_.notify_all();
  }
  void End() {
    const std::lock_guard<std::mutex> lock(mutex_);
    ended_ = true;
    came_.notify_all();
  }
  /// Lets all come, one after the other, from a thread.
  std::thread Feed(std::chrono::milliseconds period) {
    return std::thread([this, period] {
      for (std::int64_t i = 1; i <= static_cast<std::int64_t>(pairs_.size()); ++i) {
        std::this_thread::sleep_for(period);
        LetCome(i);
      }
      End();
    });
  }
  [[nodiscard]] int broken_rules() const { return broken_rules_; }

 private:
  void CheckRules(std::int64_t position) const {
    const bool is_again = !read_.insert(position).second;
    if (position < kPairsKept ? latest_ >= kPairsKept && is_again : is_again) ++broken_rules_;
    latest_ = std::max(latest_, position);
  }
  std::vector<FramePair> pairs_;
  mutable std::mutex mutex_;
  mutable std::condition_variable came_;
  std::int64_t there_ = 0;
  bool ended_ = false;
  mutable std::set<std::int64_t> read_;
  mutable std::int64_t latest_ = -1;
  mutable int broken_rules_ = 0;
};

}  // namespace stereomotion::testing
