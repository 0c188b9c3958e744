#pragma once

#include <vector>

#include "stereomotion/core/body.h"
#include "stereomotion/stereo/find_rods.h"
#include "stereomotion/stereo/match_balls.h"

namespace stereomotion {

/// Holds a placement of the body that some rods suggest.
struct PoseHypothesis {
  Rigid3 world_from_body;
  int num_balls = 0;  ///< 3D points behind it
  double rms_mm = 0;  ///< of the points against the placed body
};

/// Places the body by pairs of rods whose balls stand to each other as in the body (or, for a body
/// on one line, by single rods, with the roll nearest to `previous`). Best first: most balls, then
/// lowest misfit; at most `max_hypotheses`.
std::vector<PoseHypothesis> MakeHypotheses(const Body& body,
                                           const std::vector<StereoCandidate>& candidates,
                                           const std::vector<RodCandidate>& rods,
                                           const RodOptions& options, const Rigid3& previous,
                                           int max_hypotheses);

/// Places the body by one rod, with the smallest rotation from `previous`.
PoseHypothesis PlaceByRod(const Body& body, const std::vector<StereoCandidate>& candidates,
                          const RodCandidate& rod, const Rigid3& previous);

}  // namespace stereomotion
