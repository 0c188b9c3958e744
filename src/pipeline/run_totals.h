#pragma once

#include <string>
#include <vector>

#include "diagnose.h"
#include "ordered_pairs.h"
#include "stereomotion/core/run_summary.h"
#include "stereomotion/pipeline/level_histogram.h"
#include "stereomotion/pipeline/measure.h"

namespace stereomotion {

/// Keeps a run's totals while pairs go by, and says at the end what a person should know. Its
/// memory does not grow with the recording.
class RunTotals {
 public:
  explicit RunTotals(RunSummary& summary) : summary_(summary) {}

  void Count(const DetectedPair& pair, const PairMeasurement& measurement);
  void Finish(const MeasureSetup& setup, const MeasureOptions& options);

 private:
  void CountLoss(const DetectedPair& pair, const PairMeasurement& measurement);
  void WarnOfUnreadable();
  void WarnOfInconsistent();
  void WarnOfResiduals(const MeasureSetup& setup);

  RunSummary& summary_;
  LevelHistogram levels_;
  std::vector<FailedPair> failed_;  ///< the first ones whose images could be read
  std::string unreadable_;          ///< the first reason
  std::int64_t first_inconsistent_frame_ = -1;
};

}  // namespace stereomotion
