#include "run_totals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "stereomotion/pose/status_words.h"

namespace stereomotion {
namespace {

/// Failed pairs kept for the diagnosis, when no pair gives a pose.
constexpr std::size_t kPairsToDiagnose = 5;
/// Of the balls that these detectors saw, so many partly hidden ones are worth a word.
constexpr double kManyHidden = 0.1;

/// What the median of χ²/dof reaches by chance: its σ is √(π/2) times that of the mean, √(2/dof).
double ChanceLevel(std::int64_t dof) {
  constexpr double kSigmas = 4, kPi = 3.14159265358979;
  return dof > 0 ? 1 + kSigmas * std::sqrt(kPi / static_cast<double>(dof)) : 1;
}

}  // namespace

void RunTotals::Count(const TrackedPair& pair, ExposureResult exposure,
                      const PairMeasurement& measurement) {
  ++summary_.pairs_read;
  summary_.whole_searches_left += pair.searched_whole[0] ? 1 : 0;
  summary_.whole_searches_right += pair.searched_whole[1] ? 1 : 0;
  CountExposure(exposure);
  CountBlobs(pair);
  summary_.stage_ms["read"] += pair.read_ms;
  summary_.stage_ms["detect"] += pair.detect_ms;
  if (!measurement.pose) {
    CountLoss(pair, measurement);
    return;
  }
  ++summary_.poses;
  const bool corrected = exposure == ExposureResult::kCorrected;
  assumed_exposure_ += pair.exposure_assumed && corrected ? 1 : 0;
  dof_ += std::max(0, measurement.pose->dof);
  if (measurement.pose->dof > 0) levels_.Add(measurement.pose->chi2 / measurement.pose->dof);
}

void RunTotals::CountExposure(ExposureResult exposure) {
  summary_.poses_moved_to_mid_exposure += exposure == ExposureResult::kCorrected ? 1 : 0;
  unknown_exposure_ += exposure == ExposureResult::kUnknownTime ? 1 : 0;
  impossible_exposure_ += exposure == ExposureResult::kImpossibleTime ? 1 : 0;
  unknown_motion_ += exposure == ExposureResult::kUnknownMotion ? 1 : 0;
}

void RunTotals::CountBlobs(const TrackedPair& pair) {
  for (const auto& balls : pair.balls) {
    blobs_ += static_cast<std::int64_t>(balls.size());
    hidden_ += std::count_if(balls.begin(), balls.end(), [](const BallObservation& ball) {
      return ball.status == BlobStatus::kPartly || ball.status == BlobStatus::kPoorFit;
    });
  }
}

void RunTotals::CountLoss(const TrackedPair& pair, const PairMeasurement& measurement) {
  ++summary_.lost_by_reason[std::string(StatusWord(measurement.status))];
  const PoseStatus status = measurement.status;
  if (status == PoseStatus::kUnreadable && unreadable_.empty()) unreadable_ = measurement.detail;
  if (status == PoseStatus::kInconsistent && first_inconsistent_frame_ < 0) {
    first_inconsistent_frame_ = measurement.frame;
  }
  const bool complete = status != PoseStatus::kUnreadable && status != PoseStatus::kNoPair;
  if (complete && summary_.poses == 0 && failed_.size() < kPairsToDiagnose) {
    failed_.push_back({pair.balls[0], pair.balls[1]});
  }
}

void RunTotals::Finish(const MeasureSetup& setup, const MeasureOptions& options) {
  WarnOfUnreadable();
  if (summary_.poses == 0 && !failed_.empty()) {
    summary_.warnings.push_back(DiagnoseFailure(setup, options, failed_));
  }
  WarnOfInconsistent();
  WarnOfExposure();
  summary_.median_chi2_dof = levels_.Median();
  summary_.chi2_dof_by_chance = ChanceLevel(dof_);
  WarnOfResiduals(setup);
  WarnOfHidden(options);
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

void RunTotals::WarnOfExposure() {
  if (unknown_exposure_ > 0) {
    summary_.warnings.push_back(
        "the balls are smeared in " + std::to_string(unknown_exposure_) +
        " poses, and the recording does not tell the exposure: these poses are means over it, off "
        "the time of the frame by acceleration x exposure^2 / 24. Give --exposure-ms, or a column "
        "exposure_us in timestamps.csv");
  }
  if (assumed_exposure_ > 0) {
    summary_.warnings.push_back(
        "in " + std::to_string(assumed_exposure_) +
        " poses one camera's exposure is not told: it is taken to be as long as the other's. Give "
        "the column exposure_us in both timestamps.csv");
  }
  if (impossible_exposure_ > 0) {
    summary_.warnings.push_back(
        "in " + std::to_string(impossible_exposure_) +
        " poses the exposure is said to be longer than the time from frame to frame: nothing is "
        "corrected for it. exposure_us is in microseconds, --exposure-ms in milliseconds");
  }
  if (unknown_motion_ > 0) {
    summary_.warnings.push_back(
        "the balls are smeared in " + std::to_string(unknown_motion_) +
        " poses whose neighbours in time are missing or too far off to tell the acceleration: "
        "these poses are means over the exposure, off by acceleration x exposure^2 / 24");
  }
}

void RunTotals::WarnOfResiduals(const MeasureSetup& setup) {
  const double limit = std::max(kRemarkableChi2Dof, summary_.chi2_dof_by_chance);
  if (!summary_.median_chi2_dof || *summary_.median_chi2_dof < limit) return;
  std::array<char, 16> level{};
  std::snprintf(level.data(), level.size(), "%.1f", *summary_.median_chi2_dof);
  summary_.warnings.push_back(
      "the residuals are larger than the image noise explains (median chi2/dof " +
      std::string(level.data()) +
      ", 1 is ideal): the poses are off by more than cov_* says, possibly by many sigma. The rig "
      "or "
      "the body file is not exact, the cameras are not synchronous, or something hides parts of "
      "balls (only --detector ml models that)" +
      (setup.rig.covariance ? "; what the rig's own covariance explains stands in ucal_*" : ""));
}

void RunTotals::WarnOfHidden(const MeasureOptions& options) {
  const bool models_them = options.detection.method == DetectorMethod::kMaximumLikelihood;
  if (models_them || static_cast<double>(hidden_) < kManyHidden * static_cast<double>(blobs_)) {
    return;
  }
  if (hidden_ == 0) return;
  summary_.warnings.push_back(
      std::to_string(hidden_) + " of " + std::to_string(blobs_) +
      " balls in the images are partly hidden, merged or cut by rods: this detector is for whole "
      "balls, and those that it takes for whole may be off by many sigma. Use --detector ml");
}

}  // namespace stereomotion
