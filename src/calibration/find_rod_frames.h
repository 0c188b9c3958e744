#pragma once

#include <vector>

#include "rod_hypotheses.h"
#include "stereomotion/calibration/refine_rig.h"

namespace stereomotion {

/// Finds the frames in which both images show the same two rods whole (the rod of a body of one),
/// with the ways of matching them. Of a long run only ten frames for each of `most_frames` are
/// looked at, spread over it.
std::vector<RodFrame> FindRodFrames(const Rig& rig, const Body& body,
                                    const std::vector<RefineFrame>& frames, int most_frames);

}  // namespace stereomotion
