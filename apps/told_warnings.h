#pragma once

#include <set>
#include <string>
#include <vector>

#include "stereomotion/capture/live_report.h"
#include "stereomotion/capture/recorder.h"

namespace stereomotion::app {

/// Remembers which warnings of a live run were told, so that each is told once while the numbers in
/// it go on changing; the last ones stand in the report.
class ToldWarnings {
 public:
  /// Returns those warnings of `report` that were not told yet, and takes them as told.
  std::vector<std::string> New(const LiveReport& report);

 private:
  std::set<std::string> keys_;
};

/// Adds to the report's warnings what goes wrong with the recording, if anything does.
void AddRecorderWarnings(const RecorderCounts& counts, LiveReport& report);

}  // namespace stereomotion::app
