#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "stream_lines.h"
#include "stream_target.h"

namespace stereomotion::app {

/// Sends poses as JSON lines while they are measured, from a thread of its own.
///
/// Live, measuring never waits for a receiver: what it does not take in time is lost, whole lines,
/// counted. Replaying a recording waits for it instead, up to some seconds.
class PoseStream {
 public:
  /// Throws `UserError` for an address that is none, `OutputError` where it cannot be used.
  PoseStream(const std::string& address, StreamHello hello);
  ~PoseStream();
  PoseStream(const PoseStream&) = delete;
  PoseStream& operator=(const PoseStream&) = delete;

  /// Waits some seconds for a first receiver, where one can be noticed (TCP); `stop` ends that.
  void AwaitReceiver(const std::atomic<bool>& stop) const;
  void Tell(const PromptPose& prompt, std::optional<double> latency_ms);
  /// Sends the last line and what still waits, at most some seconds; tells of lines that were lost.
  void End(const std::string& reason);
  [[nodiscard]] std::int64_t lost_lines() const { return lost_.load() + target_lost_.load(); }

 private:
  void Work();
  bool TakeLine(std::string& line);  ///< false: none came in a while
  void RepeatHello();
  void Push(const std::string& line);

  StreamHello hello_;
  std::string address_;
  std::unique_ptr<StreamTarget> target_;  ///< used by the thread alone
  std::string line_;                      ///< of the measuring thread
  std::vector<std::string> ring_;
  std::size_t first_ = 0, waiting_ = 0;
  std::int64_t pairs_ = 0;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool patient_;
  std::chrono::steady_clock::time_point hello_at_;
  std::atomic<bool> ended_{false}, has_receiver_{false};
  std::atomic<std::int64_t> lost_{0}, target_lost_{0};
  std::thread thread_;
};

}  // namespace stereomotion::app
