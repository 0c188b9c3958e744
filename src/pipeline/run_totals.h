#pragma once

#include <string>
#include <vector>

#include "diagnose.h"
#include "exposure_correction.h"
#include "stereomotion/core/run_summary.h"
#include "stereomotion/pipeline/level_histogram.h"
#include "stereomotion/pipeline/measure.h"
#include "tracked_pair.h"

namespace stereomotion {

/// Keeps a run's totals while pairs go by, and says at the end what a person should know. Its
/// memory does not grow with the recording.
class RunTotals {
 public:
  explicit RunTotals(RunSummary& summary) : summary_(summary) {}

  void Count(const TrackedPair& pair, ExposureResult exposure, const PairMeasurement& measurement);
  void Finish(const MeasureSetup& setup, const MeasureOptions& options);

 private:
  void CountLoss(const TrackedPair& pair, const PairMeasurement& measurement);
  void CountBlobs(const TrackedPair& pair);
  void CountExposure(ExposureResult exposure);
  void WarnOfUnreadable();
  void WarnOfInconsistent();
  void WarnOfExposure();
  void WarnOfResiduals(const MeasureSetup& setup);
  void WarnOfHidden(const MeasureOptions& options);

  RunSummary& summary_;
  LevelHistogram levels_;
  std::vector<FailedPair> failed_;  ///< the first ones whose images could be read
  std::string unreadable_;          ///< the first reason
  std::int64_t first_inconsistent_frame_ = -1;
  std::int64_t unknown_exposure_ = 0;  ///< poses of smeared balls that may be off for it
  std::int64_t unknown_motion_ = 0;
  std::int64_t impossible_exposure_ = 0;
  std::int64_t assumed_exposure_ = 0;
  std::int64_t dof_ = 0;                 ///< of all poses
  std::int64_t blobs_ = 0, hidden_ = 0;  ///< all, and those that are no whole balls
};

}  // namespace stereomotion
