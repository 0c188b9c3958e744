#pragma once

#include <vector>

#include "stereomotion/pose/acquire_pose.h"

namespace stereomotion {

/// Refers to everything that one frame pair's pose is made from.
struct PoseView {
  const RigCamera& left;
  const RigCamera& right;
  const Body& body;
  const std::vector<BallObservation>& left_balls;
  const std::vector<BallObservation>& right_balls;
};

/// Turns a rough placement of the body into an estimate: assign within `gate_px`, estimate, assign
/// again around the estimate (within at most `kEstimateGatePx`), until the assignment stays.
Expected<PoseFix, PoseStatus> VerifyPose(const PoseView& view, const Rigid3& world_from_body,
                                         double gate_px, const PoseOptions& options);

/// Gate around a pose that came from the images: a rig that is a little wrong, a rough 3D point.
constexpr double kEstimateGatePx = 4;

/// Counts the outlines that a placement predicts inside both images, an occluded ball included.
int CountExpected(const PoseView& view, const Rigid3& world_from_body);

/// Says whether two poses differ by more than their uncertainty explains: a ball is more than 1 mm
/// and 10 σ apart.
bool AreDifferent(const Body& body, const PoseEstimate& a, const PoseEstimate& b);

/// Says whether `a` explains more observations than `b`, or as many with a lower χ².
bool ExplainsMore(const PoseFix& a, const PoseFix& b);

/// χ² per degree of freedom, but 1 where the fit is better than that.
double ChiSquareLevel(const PoseEstimate& pose);

/// Says whether two explanations cannot be told apart: within one observation of each other, which
/// a single false ball could supply, and of comparable χ².
bool AreRivals(const PoseFix& best, const PoseFix& other);

}  // namespace stereomotion
