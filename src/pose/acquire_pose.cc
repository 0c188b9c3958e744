#include "stereomotion/pose/acquire_pose.h"

#include <algorithm>
#include <set>
#include <stdexcept>

#include "pose/body_geometry.h"
#include "pose/pose_hypotheses.h"
#include "pose/verify_pose.h"

namespace stereomotion {
namespace {

std::vector<StereoCandidate> FindCandidates(const PoseView& view, const MatchOptions& options) {
  // The radius only moves the outline's centre, by thousandths of a pixel: one for all rods will
  // do.
  const double radius_mm = BallRadius(view.body, {0, 0});
  std::vector<StereoCandidate> candidates;
  FindStereoCandidates(view.left, view.right, view.left_balls, view.right_balls, radius_mm, options,
                       candidates);
  return candidates;
}

int CountDistinctLeft(const std::vector<StereoCandidate>& candidates) {
  std::set<int> left;
  for (const StereoCandidate& candidate : candidates) left.insert(candidate.left);
  return static_cast<int>(left.size());
}

/// Verifies the hypotheses; those that an earlier one led to, or failed at, are not tried again.
std::vector<PoseFix> VerifyAll(const PoseView& view, const std::vector<PoseHypothesis>& hypotheses,
                               const PoseOptions& options, PoseStatus& last_failure) {
  constexpr double kSameMm = 2;  // within the verification's gate of each other
  std::vector<PoseFix> fixes;
  std::vector<Rigid3> tried;
  for (const PoseHypothesis& hypothesis : hypotheses) {
    const auto same = [&](const Rigid3& other) {
      return LargestBallShift(view.body, hypothesis.world_from_body, other) < kSameMm;
    };
    if (std::any_of(tried.begin(), tried.end(), same)) continue;
    const auto fix = VerifyPose(view, hypothesis.world_from_body, kEstimateGatePx, options);
    tried.push_back(fix ? BodyPlacement(view.body, fix->pose) : hypothesis.world_from_body);
    if (fix) {
      fixes.push_back(*fix);
    } else if (last_failure == PoseStatus::kOk) {
      last_failure = fix.error();  // the best hypothesis' reason is the one to report
    }
  }
  return fixes;
}

/// Says why no pair of rods gave a hypothesis.
PoseStatus ExplainNothing(const PoseView& view, const std::vector<StereoCandidate>& candidates,
                          const std::vector<RodCandidate>& rods, const AcquireOptions& options) {
  if (CountDistinctLeft(candidates) < options.pose.min_balls) return PoseStatus::kTooFewBalls;
  if (rods.empty() || BodyLine(view.body)) return PoseStatus::kLost;
  const auto another_rod = [&](const RodCandidate& rod) { return rod.rod != rods.front().rod; };
  if (std::any_of(rods.begin(), rods.end(), another_rod)) return PoseStatus::kLost;
  const PoseHypothesis alone = PlaceByRod(view.body, candidates, rods.front(), {});
  // Only the rod's own balls can be assigned with a roll that means nothing.
  Body rod_alone = view.body;
  rod_alone.rods = {view.body.rods[static_cast<std::size_t>(rods.front().rod)]};
  const PoseView rod_view{view.left, view.right, rod_alone, view.left_balls, view.right_balls};
  const auto fix = VerifyPose(rod_view, alone.world_from_body, kEstimateGatePx, options.pose);
  return fix ? PoseStatus::kRollUndetermined : PoseStatus::kLost;
}

}  // namespace

Expected<PoseFix, PoseStatus> AcquirePose(const RigCamera& left, const RigCamera& right,
                                          const Body& body,
                                          const std::vector<BallObservation>& left_balls,
                                          const std::vector<BallObservation>& right_balls,
                                          const Rigid3& previous, const AcquireOptions& options) {
  CheckBody(body);
  if (options.max_hypotheses < 1) throw std::invalid_argument("AcquirePose: no hypotheses allowed");
  const PoseView view{left, right, body, left_balls, right_balls};
  const auto candidates = FindCandidates(view, options.match);
  const auto rods = FindRods(body, candidates, options.rods);
  const auto hypotheses =
      MakeHypotheses(body, candidates, rods, options.rods, previous, options.max_hypotheses);
  if (hypotheses.empty()) return Unexpected{ExplainNothing(view, candidates, rods, options)};

  PoseStatus failure = PoseStatus::kOk;
  std::vector<PoseFix> fixes = VerifyAll(view, hypotheses, options.pose, failure);
  if (fixes.empty()) return Unexpected{failure};
  PoseFix& best = *std::min_element(fixes.begin(), fixes.end(), ExplainsMore);
  for (const PoseFix& fix : fixes) {
    if (AreRivals(best, fix) && AreDifferent(body, best.pose, fix.pose)) {
      return Unexpected{PoseStatus::kAmbiguous};
    }
  }
  SetFreeRoll(body, previous, best.pose);
  return best;
}

}  // namespace stereomotion
