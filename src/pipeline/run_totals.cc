#include "run_totals.h"

#include <algorithm>

#include "stereomotion/pose/status_words.h"

namespace stereomotion {
namespace {

/// Failed pairs kept for the diagnosis, when no pair gives a pose.
constexpr std::size_t kPairsToDiagnose = 5;

}  // namespace

RunTotals::RunTotals(const MeasureSetup& setup, RunSummary& summary)
    : setup_(setup), summary_(summary), bodies_(setup.bodies.size()) {
  for (const Body& body : setup.bodies) summary_.bodies.emplace_back().name = body.name;
}

void RunTotals::Count(const TrackedPair& pair, ExposureResult exposure,
                      const PairMeasurement& measurement) {
  const auto body = static_cast<std::size_t>(pair.body);
  if (body == 0) CountPair(pair);
  CountExposure(exposure);
  if (measurement.pose) {
    ++summary_.bodies[body].poses;
    const bool corrected = exposure == ExposureResult::kCorrected;
    assumed_exposure_ += pair.exposure_assumed && corrected ? 1 : 0;
    CountPose(*measurement.pose, bodies_[body]);
  } else {
    CountLoss(pair, measurement);
  }
  if (body + 1 == bodies_.size() && pair_is_complete_) ++summary_.poses;
}

void RunTotals::CountPair(const TrackedPair& pair) {
  ++summary_.pairs_read;
  summary_.whole_searches_left += pair.searched_whole[0] ? 1 : 0;
  summary_.whole_searches_right += pair.searched_whole[1] ? 1 : 0;
  summary_.stage_ms["read"] += pair.read_ms;
  summary_.stage_ms["detect"] += pair.detect_ms;
  pair_is_complete_ = true;
  CountBlobs(pair);
}

void RunTotals::CountPose(const PoseEstimate& pose, OfBody& own) {
  if (pose.dof <= 0) return;
  own.dof += pose.dof;
  dof_ += pose.dof;
  own.levels.Add(pose.chi2 / pose.dof);
  levels_.Add(pose.chi2 / pose.dof);
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
  const PoseStatus status = measurement.status;
  const std::string word(StatusWord(status));
  BodySummary& total = summary_.bodies[static_cast<std::size_t>(pair.body)];
  OfBody& own = bodies_[static_cast<std::size_t>(pair.body)];
  ++total.lost_by_reason[word];
  if (pair_is_complete_) ++summary_.lost_by_reason[word];
  pair_is_complete_ = false;
  if (status == PoseStatus::kUnreadable && unreadable_.empty()) unreadable_ = measurement.detail;
  if (status == PoseStatus::kInconsistent && own.inconsistent++ == 0) {
    own.first_inconsistent_frame = measurement.frame;
  }
  const bool complete = status != PoseStatus::kUnreadable && status != PoseStatus::kNoPair &&
                        status != PoseStatus::kDropped;
  if (complete && total.poses == 0 && own.failed.size() < kPairsToDiagnose) {
    own.failed.push_back({pair.balls[0], pair.balls[1]});
  }
}

}  // namespace stereomotion
