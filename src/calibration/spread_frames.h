#pragma once

#include <vector>

#include "rod_hypotheses.h"

namespace stereomotion {

/// Chooses up to `most` frames in which the balls lie as differently as can be in both images:
/// farthest-point sampling over mean and extent of their pixels. In the order of choice: the first
/// n are spread, too. Deterministic.
std::vector<RodFrame> SpreadFrames(const std::vector<RodFrame>& frames, std::size_t most);

}  // namespace stereomotion
