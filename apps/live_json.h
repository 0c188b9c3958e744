#pragma once

#include <optional>
#include <string>

#include "stereomotion/capture/live_report.h"
#include "stereomotion/capture/recorder.h"

namespace stereomotion::app {

/// Holds what a live run measured besides what `LivePairs` tells.
struct LiveExtras {
  std::optional<double> latency_median_ms, latency_p99_ms;  ///< nothing: no pair was measured
  std::optional<RecorderCounts> recorded;                   ///< nothing: nothing was recorded
  std::string recording;                                    ///< where
  std::optional<std::int64_t> lost_stream_lines;            ///< nothing: no --stream
};

/// Spells the object `live` of run.json and record.json (docs/formats.md).
std::string LiveJson(const LiveReport& report, const LiveExtras& extras);

}  // namespace stereomotion::app
