#pragma once

#include <optional>
#include <vector>

#include "motion/group_balls.h"

namespace stereomotion {

/// Finds a body of a single rod: five points on a line (the design) that keep their spacing over
/// most frames and move. `GroupBalls` cannot, for balls on a line leave the roll open: here the
/// group's poses take the smallest turn from frame to frame. Frames that hide one of the balls are
/// left out. Nothing where there is none, or where its spacing is its own mirror image, so that its
/// ends cannot be told apart. Of several the one found in most frames is given, of equal ones the
/// longest.
std::optional<BallGroup> FindLoneRod(const std::vector<PointCloud>& frames,
                                     const GroupOptions& options = {});

}  // namespace stereomotion
