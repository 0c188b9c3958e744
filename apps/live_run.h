#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "camera_argument.h"
#include "live_json.h"
#include "live_options.h"
#include "live_view.h"
#include "stereomotion/capture/live_pairs.h"
#include "stereomotion/capture/recorder.h"
#include "stereomotion/pipeline/level_histogram.h"
#include "stereomotion/pipeline/measure.h"
#include "told_warnings.h"

namespace stereomotion::app {

/// Says which cameras are to be opened, for which cameras of the rig, and what is recorded.
struct LiveRunSetup {
  const MeasureSetup& setup;
  const ResolvedCameras& cameras;
  LiveArguments arguments;
  std::string rig_file;  ///< for messages
  std::string record;    ///< folder or ….h5; empty: nothing
  bool overwrite = false;
  bool show_bodies = true;
  bool quiet = false;
};

/// Runs two live cameras: opens them, records if wanted, measures the latency, shows how it goes,
/// and ends the stream when SIGINT or SIGTERM comes; the pairs that wait then are still delivered.
class LiveRun {
 public:
  /// Opens the cameras and starts the recorder. Throws `DeviceError`, `UserError`, `OutputError`.
  explicit LiveRun(const LiveRunSetup& run);
  ~LiveRun();
  LiveRun(const LiveRun&) = delete;
  LiveRun& operator=(const LiveRun&) = delete;

  void Start();
  [[nodiscard]] const PairSource& source() const { return *pairs_; }
  /// Takes a measured pose; returns its latency from mid-exposure to now.
  double Tell(const PromptPose& prompt);
  /// Ends the stream as soon as possible; safe from any thread.
  void Stop(const std::string& why) { pairs_->Stop(why); }
  /// Closes cameras and recording. After it only what follows may be called.
  void End();
  [[nodiscard]] const LiveReport& report() const { return report_; }
  /// Spells the object `live` of run.json.
  [[nodiscard]] std::string Json(std::optional<std::int64_t> lost_stream_lines) const;
  /// Says why it did not end as asked, for a person; empty: it did.
  [[nodiscard]] const std::string& problem() const { return report_.problem; }
  void ClearView() { view_.Clear(); }

 private:
  void Watch();
  void TellNewWarnings(const LiveReport& report);
  void EndRecording();
  [[nodiscard]] std::optional<RecorderCounts> recorded() const;

  std::string record_;
  std::unique_ptr<Recorder> recorder_;
  std::unique_ptr<LivePairs> pairs_;
  LiveView view_;
  /// Of the pairs with a pose that were taken since measuring runs: those before waited for the
  /// clocks and the noise to be learned.
  LevelHistogram latency_ms_;
  std::int64_t measuring_since_ns_ = 0;  ///< host time of the first result; 0: none yet
  std::int64_t last_frame_ = -1;
  LiveReport report_;
  std::optional<RecorderCounts> counts_;
  ToldWarnings told_;
  std::atomic<bool> ended_{false};
  std::thread watcher_;
};

}  // namespace stereomotion::app
