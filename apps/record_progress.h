#pragma once

#include <chrono>
#include <filesystem>

#include "record_disk.h"
#include "stereomotion/capture/live_report.h"
#include "stereomotion/capture/recorder.h"
#include "told_warnings.h"

namespace stereomotion::app {

/// Tells on stderr how a recording goes: a line on a terminal, warnings anywhere.
class RecordProgress {
 public:
  RecordProgress(std::filesystem::path output, DiskState disk, bool quiet);
  ~RecordProgress() { Clear(); }
  RecordProgress(const RecordProgress&) = delete;
  RecordProgress& operator=(const RecordProgress&) = delete;

  /// To be called several times a second.
  void Show(const LiveReport& report, const RecorderCounts& counts);
  void Clear() const;

 private:
  using Clock = std::chrono::steady_clock;
  void TellOfDisk(double bytes_s);
  void TellWarnings(const LiveReport& report, const RecorderCounts& counts);
  void Draw(const LiveReport& report, const RecorderCounts& counts, double bytes_s);

  const std::filesystem::path output_;
  DiskState disk_;
  const bool on_terminal_;
  bool disk_told_ = false;
  bool dropped_told_ = false;
  ToldWarnings told_;
  Clock::time_point start_ = Clock::now(), first_bytes_ = start_, drawn_ = start_;
  std::int64_t bytes_at_first_ = 0;
};

}  // namespace stereomotion::app
