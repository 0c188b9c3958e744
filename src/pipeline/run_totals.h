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
  RunTotals(const MeasureSetup& setup, RunSummary& summary);

  /// Counts what was measured of one body; of a pair body by body, in their order.
  void Count(const TrackedPair& pair, ExposureResult exposure, const PairMeasurement& measurement);
  void Finish(const MeasureOptions& options);

 private:
  /// What is kept of one body.
  struct OfBody {
    LevelHistogram levels;
    std::int64_t dof = 0;            ///< of all poses
    std::vector<FailedPair> failed;  ///< the first ones whose images could be read
    std::int64_t inconsistent = 0, first_inconsistent_frame = -1;
  };
  void CountPair(const TrackedPair& pair);
  void CountPose(const PoseEstimate& pose, OfBody& own);
  void CountLoss(const TrackedPair& pair, const PairMeasurement& measurement);
  void CountBlobs(const TrackedPair& pair);
  void CountExposure(ExposureResult exposure);
  void FinishBody(std::size_t body);
  void DiagnoseBodies(const MeasureOptions& options);
  void WarnOfUnreadable();
  void WarnOfInconsistent(std::size_t body);
  void WarnOfExposure();
  void WarnOfResiduals(std::size_t body);
  void WarnOfHidden(const MeasureOptions& options);
  /// Says which body a warning is about, where there are several.
  void Warn(std::size_t body, const std::string& text);

  const MeasureSetup& setup_;
  RunSummary& summary_;
  std::vector<OfBody> bodies_;
  LevelHistogram levels_;              ///< of all bodies
  bool pair_is_complete_ = true;       ///< so far, all bodies have a pose in the pair in hand
  std::string unreadable_;             ///< the first reason
  std::int64_t unknown_exposure_ = 0;  ///< poses of smeared balls that may be off for it
  std::int64_t unknown_motion_ = 0;
  std::int64_t impossible_exposure_ = 0;
  std::int64_t assumed_exposure_ = 0;
  std::int64_t dof_ = 0;                 ///< of all poses
  std::int64_t blobs_ = 0, hidden_ = 0;  ///< all, and those that are no whole balls
};

}  // namespace stereomotion
