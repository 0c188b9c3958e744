#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <utility>

#include "camera_timeline.h"
#include "ring.h"

namespace stereomotion {

/// What a receiving thread tells the pairing thread.
struct LiveEvent {
  enum class Kind { kFrame, kDown, kClosed };
  Kind kind = Kind::kFrame;
  int camera = 0;
  LiveFrame frame;
};

/// Carries events from the receiving threads to the pairing one; nobody waits who puts in.
class LiveInbox {
 public:
  void Put(LiveEvent event) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      events_.push_back(std::move(event));
    }
    changed_.notify_one();
  }
  /// Takes the next event; false: none came in time.
  bool Take(std::chrono::milliseconds at_most, LiveEvent& event) {
    std::unique_lock<std::mutex> lock(mutex_);
    if (!changed_.wait_for(lock, at_most, [&] { return !events_.empty(); })) return false;
    event = events_.pop_front();
    return true;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  Ring<LiveEvent> events_;
};

}  // namespace stereomotion
