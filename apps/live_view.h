#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "stereomotion/capture/live_report.h"
#include "stereomotion/capture/recorder.h"
#include "stereomotion/core/body.h"
#include "stereomotion/pipeline/measure.h"

namespace stereomotion::app {

/// Shows on stderr how a live run does: on a terminal a few lines that are drawn anew, else a line
/// in the log every ten seconds. `Tell` and the others may be called from different threads.
class LiveView {
 public:
  /// No bodies: shows the stream alone.
  LiveView(const std::vector<Body>& bodies, bool quiet);
  ~LiveView() { Clear(); }
  LiveView(const LiveView&) = delete;
  LiveView& operator=(const LiveView&) = delete;

  /// Takes what was measured; copies numbers only.
  void Tell(const PromptPose& prompt, double latency_ms);
  /// Tells whether it is time to show something again.
  [[nodiscard]] bool IsDue() const;
  void Show(const LiveReport& report, const std::optional<RecorderCounts>& recorded);
  /// Takes the lines away, so that a message gets a line of its own.
  void Clear();

 private:
  using Clock = std::chrono::steady_clock;
  /// What was seen last of a body.
  struct Seen {
    std::string name;
    PoseStatus status = PoseStatus::kLost;
    int detections_left = 0, detections_right = 0;
    std::optional<PoseEstimate> pose;
    Clock::time_point posed_at;
  };
  [[nodiscard]] std::string StreamLine(const LiveReport& report, Clock::time_point now);
  [[nodiscard]] static std::string BodyLine(const Seen& seen);
  [[nodiscard]] std::string LatencyLine(const std::optional<RecorderCounts>& recorded) const;
  [[nodiscard]] std::vector<std::string> Alarms(const LiveReport& report,
                                                const std::optional<RecorderCounts>& recorded,
                                                Clock::time_point now);
  void Draw(const std::vector<std::string>& lines);

  bool on_terminal_, on_log_;
  mutable std::mutex mutex_;
  std::vector<Seen> bodies_;
  std::int64_t pairs_ = 0, pairs_shown_ = 0, dropped_shown_ = 0;
  double latency_ms_ = 0;  ///< smoothed
  double rate_hz_ = 0;     ///< smoothed
  Clock::time_point shown_at_ = Clock::now();
  std::size_t lines_drawn_ = 0;
};

}  // namespace stereomotion::app
