#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>

namespace stereomotion {

/// Tells several threads to end, also those that sleep.
class StopSignal {
 public:
  void Raise() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      raised_ = true;
    }
    changed_.notify_all();
  }
  [[nodiscard]] bool raised() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return raised_;
  }
  /// Sleeps until then at most; true: raised.
  bool WaitUntil(std::chrono::steady_clock::time_point then) const {
    std::unique_lock<std::mutex> lock(mutex_);
    return changed_.wait_until(lock, then, [&] { return raised_; });
  }

 private:
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  bool raised_ = false;
};

}  // namespace stereomotion
