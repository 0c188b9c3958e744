#pragma once

#include <Eigen/Core>
#include <vector>

#include "stereomotion/core/body.h"
#include "stereomotion/stereo/match_balls.h"

namespace stereomotion {

/// Holds 3D candidates that lie like the balls of one rod.
struct RodCandidate {
  int rod = -1;                 ///< index into the body's rods
  std::vector<int> candidates;  ///< per ball of the rod: index into the stereo candidates, or −1
  int num_balls = 0;            ///< how many of them are not −1
  double cost = 0;              ///< summed squared normalised deviation from the rod's geometry
};

struct RodOptions {
  int min_balls = 3;
  double distance_tolerance = 0.01;  ///< relative: room for a rig that is a little wrong
  double gate_sigma = 5;             ///< plus this many standard deviations of the distance
  int max_per_rod = 200;             ///< best ones kept: false balls must not flood the caller
};

/// Finds sets of 3D candidates that are collinear with the spacing of a rod of `body`, tried in
/// both directions, balls may be missing; no detection serves two balls of one rod. Best first:
/// most balls, then lowest cost; equal up to the order of the candidates. A rod whose spacing is
/// its own mirror image appears twice. A set that is part of another one of the same rod is left
/// out.
///
/// A rod is a straight line: its balls' distances from the first one are its spacing. Throws
/// std::invalid_argument for two balls in one place and for options out of range.
std::vector<RodCandidate> FindRods(const Body& body, const std::vector<StereoCandidate>& candidates,
                                   const RodOptions& options = {});

}  // namespace stereomotion
