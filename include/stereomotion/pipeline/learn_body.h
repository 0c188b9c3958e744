#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "stereomotion/core/body.h"
#include "stereomotion/core/expected.h"
#include "stereomotion/pipeline/measure.h"

namespace stereomotion {

/// Says why no body was learned (words: docs/formats.md).
enum class LearnBodyFailure {
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

/// Learns the bodies of a recording: balls followed in 3D → groups that keep their mutual distances
/// → rods (collinear balls) → structure and motion refined together (`RefineStructure`).
/// Body frame: origin at the balls' centroid, axes as the world's in the first pair with a pose.
/// `setup.bodies` is not read. Balls that rest are the background's, unless nothing else moves.
Expected<LearnedBodies, LearnBodyFailure> LearnBodies(const PairSource& source,
                                                      const MeasureSetup& setup,
                                                      const LearnBodyOptions& options,
                                                      const std::atomic<bool>* stop = nullptr);

}  // namespace stereomotion
