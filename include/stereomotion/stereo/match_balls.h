#pragma once

#include <Eigen/Core>
#include <vector>

#include "stereomotion/camera/rig.h"
#include "stereomotion/detection/ball_observation.h"
#include "stereomotion/stereo/triangulate.h"

namespace stereomotion {

/// Holds a left and a right detection that may be the same ball, with the 3D point that they give.
struct StereoCandidate {
  int left = -1;   ///< index into the left detections
  int right = -1;  ///< index into the right detections
  TriangulatedPoint point;
};

struct MatchOptions {
  double gate_sigma = 5;  ///< epipolar gate, in standard deviations of the distance
  /// Slack for what the covariances do not know (rig not perfect); added in quadrature [px].
  double rig_slack_px = 1.0;
  double max_size_ratio = 1.6;  ///< of the ball's apparent size × depth between the cameras
};

/// Finds all left–right pairs of detections that pass the epipolar gate and lie before both
/// cameras; ordered by left, then right. One detection may stand in several candidates.
///
/// `ball_radius_mm` removes the perspective shift of the sphere's outline (two fixed-point steps);
/// 0: not removed.
void FindStereoCandidates(const RigCamera& left, const RigCamera& right,
                          const std::vector<BallObservation>& left_balls,
                          const std::vector<BallObservation>& right_balls, double ball_radius_mm,
                          const MatchOptions& options, std::vector<StereoCandidate>& candidates);

/// Assigns left to right detections one to one so that the summed cost is smallest, non-matches
/// costing `no_match_cost` each (Kuhn–Munkres; Kuhn 1955). `cost(i, j)`: rows left, columns right,
/// infinity forbids. Returns the column of every row, −1 for none.
/// A non-match is a ROW without a column; columns left over cost nothing. NaN or −∞ in `cost` and a
/// `no_match_cost` that is not finite throw std::invalid_argument.
std::vector<int> AssignOneToOne(const Eigen::MatrixXd& cost, double no_match_cost);

}  // namespace stereomotion
