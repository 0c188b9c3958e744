#pragma once

#include <vector>

#include "stereomotion/stereo/find_rods.h"

namespace stereomotion {

/// Lists the distinct sets of candidates that lie like a rod whose balls stand at `place_mm` along
/// it (≥ 2 different places), fitted, in no particular order; `rod` stays −1.
///
/// Each candidate in turn is taken for each ball; its neighbours are filed by the spacings that
/// they could be, so that looking along a line means looking into a short list.
std::vector<RodCandidate> SearchRod(const std::vector<StereoCandidate>& candidates,
                                    const std::vector<double>& place_mm, const RodOptions& options);

}  // namespace stereomotion
