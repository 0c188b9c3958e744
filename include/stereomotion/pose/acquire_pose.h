#pragma once

#include <vector>

#include "stereomotion/pose/estimate_pose.h"
#include "stereomotion/stereo/find_rods.h"
#include "stereomotion/stereo/match_balls.h"

namespace stereomotion {

struct AcquireOptions {
  MatchOptions match;
  RodOptions rods;
  PoseOptions pose;
  int max_hypotheses = 200;  ///< rod combinations that are verified, best first
};

/// Holds a pose and the detections that carry it.
struct PoseFix {
  PoseEstimate pose;
  std::vector<BallAssignment> used;
};

/// Finds the pose of `body` from nothing: stereo candidates → rods → pose hypotheses, each verified
/// by projecting all balls into both images; the one that explains most observations wins. Reasons
/// for no pose: kTooFewBalls, kLost, kAmbiguous (a different pose explains as much),
/// kRollUndetermined.
/// `previous` only serves a single-rod body: its free roll stays closest to it.
Expected<PoseFix, PoseStatus> AcquirePose(const RigCamera& left, const RigCamera& right,
                                          const Body& body,
                                          const std::vector<BallObservation>& left_balls,
                                          const std::vector<BallObservation>& right_balls,
                                          const Rigid3& previous = {},
                                          const AcquireOptions& options = {});

/// Collects the detections that lie where a pose predicts balls: per camera one global assignment
/// within `gate_px` of the predicted outline centres.
std::vector<BallAssignment> AssignDetections(const RigCamera& left, const RigCamera& right,
                                             const Body& body,
                                             const std::vector<BallObservation>& left_balls,
                                             const std::vector<BallObservation>& right_balls,
                                             const Rigid3& world_from_body, double gate_px);

}  // namespace stereomotion
