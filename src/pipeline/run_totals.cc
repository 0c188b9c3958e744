#include "run_totals.h"

#include <cmath>

#include "stereomotion/pose/status_words.h"

namespace stereomotion {
namespace {

/// Failed pairs kept for the diagnosis, when no pair gives a pose.
constexpr std::size_t kPairsToDiagnose = 5;
/// Residuals this many times above the noise's (χ²/dof) are worth a word: rig, body or time is off.
constexpr double kRemarkableChi2Dof = 4;

}  // namespace

void RunTotals::Count(const DetectedPair& pair, const PairMeasurement& measurement) {
  ++summary_.pairs_read;
  summary_.stage_ms["read"] += pair.read_ms;
  summary_.stage_ms["detect"] += pair.detect_ms;
  if (!measurement.pose) {
    CountLoss(pair, measurement);
    return;
  }
  ++summary_.poses;
  if (measurement.pose->dof > 0) levels_.Add(measurement.pose->chi2 / measurement.pose->dof);
}

void RunTotals::CountLoss(const DetectedPair& pair, const PairMeasurement& measurement) {
  ++summary_.lost_by_reason[std::string(StatusWord(measurement.status))];
  const PoseStatus status = measurement.status;
  if (status == PoseStatus::kUnreadable && unreadable_.empty()) unreadable_ = measurement.detail;
  if (status == PoseStatus::kInconsistent && first_inconsistent_frame_ < 0) {
    first_inconsistent_frame_ = measurement.frame;
  }
  const bool complete = status != PoseStatus::kUnreadable && status != PoseStatus::kNoPair;
  if (complete && summary_.poses == 0 && failed_.size() < kPairsToDiagnose) {
    failed_.push_back({pair.left, pair.right});
  }
}

void RunTotals::Finish(const MeasureSetup& setup, const MeasureOptions& options) {
  WarnOfUnreadable();
  if (summary_.poses == 0 && !failed_.empty()) {
    summary_.warnings.push_back(DiagnoseFailure(setup, options, failed_));
  }
  WarnOfInconsistent();
  summary_.median_chi2_dof = levels_.Median();
  WarnOfResiduals(setup);
}

void RunTotals::WarnOfUnreadable() {
  if (unreadable_.empty()) return;
  summary_.warnings.push_back(
      std::to_string(summary_.lost_by_reason.at("unreadable")) +
      " frame pairs have an image that cannot be used, the first: " + unreadable_);
}

void RunTotals::WarnOfInconsistent() {
  if (first_inconsistent_frame_ < 0) return;
  summary_.warnings.push_back(
      std::to_string(summary_.lost_by_reason.at("inconsistent")) +
      " frame pairs, the first being frame " + std::to_string(first_inconsistent_frame_) +
      ", contradict the rig far more than those before (residuals over ten times the usual, or one "
      "camera explained by no pose): a camera was moved, or the cameras lost step. Their poses are "
      "withheld");
}

void RunTotals::WarnOfResiduals(const MeasureSetup& setup) {
  if (!summary_.median_chi2_dof || *summary_.median_chi2_dof < kRemarkableChi2Dof) return;
  summary_.warnings.push_back(
      "the residuals are larger than the image noise explains (median chi2/dof " +
      std::to_string(std::lround(*summary_.median_chi2_dof)) +
      "): the rig or the body file is not exact, the cameras are not synchronous, or rods cut the "
      "balls' limbs. The poses are off by more than cov_*, which states the image noise only" +
      (setup.rig.covariance ? "; what the rig's own covariance explains stands in ucal_*" : ""));
}

}  // namespace stereomotion
