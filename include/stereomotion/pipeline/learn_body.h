#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "stereomotion/core/body.h"
#include "stereomotion/core/expected.h"
#include "stereomotion/pipeline/measure.h"

namespace stereomotion {

/// So many pairs with a body tell it from points that stand so by chance.
constexpr std::int64_t kFewestPairsToLearn = 3;

/// Says why no body was learned (words: docs/formats.md).
enum class LearnBodyFailure {
  kTooFewPairs,  ///< fewer than kFewestPairsToLearn were read
  kTooFewBalls,  ///< fewer than four balls could be followed in 3D
  kNoMotion,     ///< nothing moves: bodies and background cannot be told apart
  kNoGroup,      ///< no balls keep their mutual distances
  kInterrupted,
};

struct LearnBodyOptions {
  MeasureOptions measure;
  double ball_diameter_mm = 0;   ///< 0: from the images (apparent size × depth)
  std::int64_t max_pairs = 600;  ///< so many pairs, consecutive, tell the structure
};

struct LearnedBodies {
  std::vector<Body> bodies;  ///< with covariance; most balls first, then by place
  std::vector<std::string> warnings;
};

/// Learns the bodies of a recording.
///
/// Balls of both images are paired by an epipolar gate that the recording itself tells → points
/// that keep their mutual distances are groups, found in each pair by those distances alone
/// (`GroupBalls` in the sources), so that neither large motion nor gaps matter → a group that
/// moves, with rods (3 to 9 balls on a line; 5 is the design), is a body → its structure and motion
/// are refined together (`RefineStructure`), the recording is measured with it, and it is refined
/// again on all of that.
///
/// Body frame: origin at the balls' centroid, axes as the world's in the first pair with a pose
/// (from the first round, so to its noise). The covariance is random and common part (rig)
/// together, in that gauge: rank 3M − 6. A rod of five that is alone (free roll) is learned as
/// straight, rank M − 1. Balls that rest are the background's; where nothing moves,
/// what rests is taken for a body if it has a rod of five, with a warning. Balls on no rod are left
/// out, with a warning. A significant lag
/// of the right camera is estimated with the body and taken off, with a warning. `setup.bodies` is
/// not read. `each_pair` is called after each pair of either round: twice a pair where bodies are
/// found. The result does not depend on the number of threads. Throws std::invalid_argument for
/// cameras that the rig does not have.
Expected<LearnedBodies, LearnBodyFailure> LearnBodies(const PairSource& source,
                                                      const MeasureSetup& setup,
                                                      const LearnBodyOptions& options,
                                                      const std::atomic<bool>* stop = nullptr,
                                                      const std::function<void()>& each_pair = {});

}  // namespace stereomotion
