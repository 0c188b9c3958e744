#pragma once

#include <optional>
#include <vector>

#include "motion/group_balls.h"

namespace stereomotion {

/// Finds a group in all frames, starting from points of one frame, and completes it; nothing where
/// that leaves too few balls or frames.
std::optional<BallGroup> GrowGroup(const PointCloud& start, const std::vector<PointCloud>& frames,
                                   const GroupOptions& options);

}  // namespace stereomotion
