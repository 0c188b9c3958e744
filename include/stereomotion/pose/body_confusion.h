#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "stereomotion/core/body.h"
#include "stereomotion/stereo/find_rods.h"

namespace stereomotion {

struct ConfusionOptions {
  RodOptions rods;  ///< what acquisition takes for the same distance
  /// Standard uncertainty of a ball's 3D position: that of weak light, 0.03 px at 2 m.
  double ball_sigma_mm = 0.1;
};

/// Tells how nearly the balls of one body can pass for those of another.
struct BodyConfusion {
  std::vector<std::pair<int, int>> rods;  ///< of the first body and of the second: two, or one
  /// Swap margin: RMS distance of the balls after the best rigid alignment.
  double margin_mm = 0;
  double needed_mm = 0;  ///< what tells them apart
  [[nodiscard]] bool alike() const { return margin_mm < needed_mm; }
};

/// Finds where two bodies are most alike: the rods that acquisition needs for a pose (two, or one
/// where a body has no more), balls on balls in both directions, whole rods; a rod of fewer balls
/// also on any part of one of more. With `balls` given, any so many of each rod (3: the fewest that
/// acquisition takes for a rod).
///
/// Needed is what a rig within acquisition's tolerance cannot tell from a scale error
/// (`distance_tolerance` × the balls' RMS distance from their middle), and `gate_sigma` times the σ
/// of a ball's position, image noise and both bodies' σ together. Nothing where no rods correspond:
/// balls whose sizes differ as much as `AssignDetections` never lets pass are never taken for each
/// other.
std::optional<BodyConfusion> FindConfusion(const Body& first, const Body& second,
                                           const ConfusionOptions& options = {}, int balls = 0);

}  // namespace stereomotion
