#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>

namespace stereomotion {

/// Tells several threads to end, also those that sleep, and keeps why.
class StopSignal {
 public:
  /// The first reason stands: a word, and what went wrong, for a person, or an empty text.
  void Raise(const std::string& why, const std::string& problem) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (!raised_) {
        why_ = why;
        problem_ = problem;
      }
      raised_ = true;
    }
    changed_.notify_all();
  }
  [[nodiscard]] bool raised() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return raised_;
  }
  [[nodiscard]] std::string why() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return why_;
  }
  [[nodiscard]] std::string problem() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return problem_;
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
  std::string why_, problem_;
};

}  // namespace stereomotion
