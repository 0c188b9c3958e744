#pragma once

#include <chrono>
#include <cstdint>

namespace stereomotion::app {

/// Draws a progress bar on stderr where that is a terminal; else does nothing.
class Progress {
 public:
  /// `unit`: what is counted, for the rate.
  Progress(std::int64_t total, bool quiet, const char* unit = "pairs");
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Counts one more; redraws at most ten times a second.
  void Step();

  /// Takes the bar away, so that a message gets a line of its own; the next `Step` brings it back.
  void Clear() const;

 private:
  void Draw(double elapsed_s) const;

  using Clock = std::chrono::steady_clock;
  std::int64_t total_;
  std::int64_t done_ = 0;
  bool shown_;
  const char* unit_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point drawn_ = start_;
};

}  // namespace stereomotion::app
