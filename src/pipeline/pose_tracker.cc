#include "stereomotion/pipeline/pose_tracker.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "pose/body_geometry.h"
#include "pose/verify_pose.h"
#include "stereomotion/camera/sphere_projection.h"
#include "stereomotion/core/units.h"
#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

/// Half the smallest distance between two outlines of neighbours on a rod: beyond it, a ball could
/// be taken for the next one.
double SafeGatePx(const PoseView& view, const Rigid3& placement) {
  double smallest_px = std::numeric_limits<double>::infinity();
  for (const RigCamera* camera : {&view.left, &view.right}) {
    for (const Rod& rod : view.body.rods) {
      for (std::size_t i = 1; i < rod.balls_in_body_mm.size(); ++i) {
        const auto a_px = ProjectWorldPoint(*camera, placement * rod.balls_in_body_mm[i - 1]);
        const auto b_px = ProjectWorldPoint(*camera, placement * rod.balls_in_body_mm[i]);
        if (a_px && b_px) smallest_px = std::min(smallest_px, (*a_px - *b_px).norm());
      }
    }
  }
  return smallest_px / 2;
}

/// Pixels that a millimetre at the body covers at most.
double PixelsPerMm(const PoseView& view, const Rigid3& placement) {
  double scale = 0;
  for (const RigCamera* camera : {&view.left, &view.right}) {
    const double depth_mm = (camera->cam_from_world * (placement * Centroid(view.body))).z();
    if (depth_mm > 0)
      scale = std::max(scale, std::max(camera->model.fx_px, camera->model.fy_px) / depth_mm);
  }
  return scale;
}

double ExplainedShare(const PoseView& view, const PoseFix& fix) {
  const int expected = CountExpected(view, BodyPlacement(view.body, fix.pose));
  return static_cast<double>(fix.used.size()) / std::max(1, expected);
}

/// So many balls that one camera measures well and the pose explains none of say that this camera
/// or the pose is wrong.
constexpr std::ptrdiff_t kBallsThatContradict = 3;

std::ptrdiff_t CountMeasured(const std::vector<BallObservation>& balls) {
  return std::count_if(balls.begin(), balls.end(),
                       [](const BallObservation& ball) { return ball.status == BlobStatus::kOk; });
}

}  // namespace

PoseTracker::PoseTracker(RigCamera left, RigCamera right, Body body, TrackerOptions options)
    : left_(std::move(left)), right_(std::move(right)), body_(std::move(body)), options_(options) {
  CheckBody(body_);
  if (!(options_.max_acceleration_mm_s2 > 0) || !(options_.max_gap_s >= 0) ||
      !(options_.min_explained > 0 && options_.min_explained <= 1)) {
    throw std::invalid_argument("PoseTracker: an option is out of range");
  }
}

std::optional<PoseTracker::Prediction> PoseTracker::Predict(std::int64_t timestamp_ns) const {
  if (!last_) return std::nullopt;
  const double gap_s = SecondsBetween(last_->timestamp_ns, timestamp_ns);
  if (gap_s > options_.max_gap_s) return std::nullopt;
  // At rest so far as is known; how wrong that is, nothing tells.
  Prediction prediction{last_->world_from_body, std::numeric_limits<double>::infinity()};
  if (!before_last_) return prediction;
  const double past_s = SecondsBetween(before_last_->timestamp_ns, last_->timestamp_ns);
  if (past_s <= 0 || past_s > options_.max_gap_s) return prediction;

  const double ratio = gap_s / past_s;
  const Eigen::Vector3d centroid_mm = Centroid(body_);
  const Rigid3& before = before_last_->world_from_body;
  const Rigid3& last = last_->world_from_body;
  const Eigen::Vector3d turn_rad = LogSO3(last.rotation * before.rotation.conjugate());
  const Eigen::Vector3d centroid_in_world_mm =
      last * centroid_mm + ratio * (last * centroid_mm - before * centroid_mm);
  Rigid3& placement = prediction.world_from_body;
  placement.rotation = (ExpSO3(ratio * turn_rad) * last.rotation).normalized();
  placement.translation_mm = centroid_in_world_mm - placement.rotation * centroid_mm;
  // The mean velocity of the past interval is that of its middle: ½ a Δt (Δt + Δt_past).
  prediction.error_mm = 0.5 * options_.max_acceleration_mm_s2 * gap_s * (gap_s + past_s);
  return prediction;
}

Rigid3 PoseTracker::Previous() const { return last_ ? last_->world_from_body : Rigid3{}; }

Expected<PoseFix, PoseStatus> PoseTracker::Track(std::int64_t timestamp_ns,
                                                 const std::vector<BallObservation>& left_balls,
                                                 const std::vector<BallObservation>& right_balls) {
  Expected<PoseFix, PoseStatus> fix = Search(timestamp_ns, left_balls, right_balls);
  if (!fix) return fix;
  return Accept(timestamp_ns, std::move(*fix), left_balls, right_balls);
}

Expected<PoseFix, PoseStatus> PoseTracker::Accept(std::int64_t timestamp_ns, PoseFix fix,
                                                  const std::vector<BallObservation>& left_balls,
                                                  const std::vector<BallObservation>& right_balls) {
  SetFreeRoll(body_, Previous(), fix.pose);
  before_last_ = last_;
  // Roughly right even where it is withheld: good enough to predict from.
  last_ = TimedPose{timestamp_ns, BodyPlacement(body_, fix.pose)};
  if (IsInconsistent({left_, right_, body_, left_balls, right_balls}, fix)) {
    return Unexpected{PoseStatus::kInconsistent};
  }
  if (fix.pose.dof > 0) levels_.Add(fix.pose.chi2 / fix.pose.dof);
  return fix;
}

bool PoseTracker::IsInconsistent(const PoseView& view, const PoseFix& fix) const {
  const PoseEstimate& pose = fix.pose;
  if (pose.balls_left == 0 && CountMeasured(view.left_balls) >= kBallsThatContradict) return true;
  if (pose.balls_right == 0 && CountMeasured(view.right_balls) >= kBallsThatContradict) return true;
  if (pose.dof <= 0 || levels_.count() < options_.poses_for_usual_level) return false;
  const double usual = std::max(1.0, *levels_.Median());
  return pose.chi2 / pose.dof > options_.max_level_ratio * usual;
}

PoseTracker::Followed PoseTracker::FollowPrediction(std::int64_t timestamp_ns,
                                                    const PoseView& view) const {
  Followed followed;
  const auto prediction = Predict(timestamp_ns);
  if (!prediction) return followed;
  const Rigid3& placement = prediction->world_from_body;
  const double safe_px = SafeGatePx(view, placement);
  const double wanted_px =
      std::max(kEstimateGatePx, prediction->error_mm * PixelsPerMm(view, placement));
  followed.identity_safe = wanted_px <= safe_px;
  const auto fix = VerifyPose(view, placement, std::min(wanted_px, safe_px), options_.acquire.pose);
  if (!fix) return followed;
  followed.complete = followed.identity_safe && ExplainedShare(view, *fix) >= 1;
  followed.fix = *fix;
  return followed;
}

std::optional<PoseFix> PoseTracker::Follow(std::int64_t timestamp_ns,
                                           const std::vector<BallObservation>& left_balls,
                                           const std::vector<BallObservation>& right_balls) const {
  Followed followed =
      FollowPrediction(timestamp_ns, {left_, right_, body_, left_balls, right_balls});
  if (!followed.complete) return std::nullopt;
  return std::move(followed.fix);
}

Expected<PoseFix, PoseStatus> PoseTracker::Search(
    std::int64_t timestamp_ns, const std::vector<BallObservation>& left_balls,
    const std::vector<BallObservation>& right_balls) const {
  if (last_ && timestamp_ns < last_->timestamp_ns) {
    throw std::invalid_argument("PoseTracker: the times decrease");
  }
  const PoseView view{left_, right_, body_, left_balls, right_balls};
  const Followed followed = FollowPrediction(timestamp_ns, view);
  if (followed.complete) return *followed.fix;
  // Something that should be seen is not: occluded, or the track is wrong. Let both explanations
  // compete.
  const auto acquired =
      AcquirePose(left_, right_, body_, left_balls, right_balls, Previous(), options_.acquire);
  return Choose(view, followed.fix, followed.identity_safe, acquired);
}

Expected<PoseFix, PoseStatus> PoseTracker::Choose(
    const PoseView& view, const std::optional<PoseFix>& tracked, bool identity_safe,
    const Expected<PoseFix, PoseStatus>& acquired) const {
  if (!tracked) return acquired;
  if (acquired) {
    if (ExplainsMore(*acquired, *tracked)) {
      // Where images alone cannot decide, continuity does, if nothing could have slipped.
      const bool rivals =
          AreRivals(*acquired, *tracked) && AreDifferent(body_, acquired->pose, tracked->pose);
      if (rivals && identity_safe) return *tracked;
      if (rivals) return Unexpected{PoseStatus::kAmbiguous};
      return acquired;
    }
    if (!AreDifferent(body_, acquired->pose, tracked->pose)) return *tracked;
    if (!identity_safe && AreRivals(*tracked, *acquired)) return Unexpected{PoseStatus::kAmbiguous};
  } else if (acquired.error() == PoseStatus::kAmbiguous && !identity_safe) {
    return acquired;
  }
  if (ExplainedShare(view, *tracked) >= options_.min_explained) return *tracked;
  return Unexpected{acquired ? PoseStatus::kLost : acquired.error()};
}

}  // namespace stereomotion
