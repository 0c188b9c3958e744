#pragma once

#include <cstddef>
#include <vector>

#include "stereomotion/motion/analyse_motion.h"

namespace stereomotion {

/// Estimates the right camera's time offset, moves the recording by it where it is significant, and
/// fits the spin centre to every `stride`-th pose. Fills `series`, `spin`, `time_offset` and
/// `time_offset_applied`; returns which frames know their centre.
std::vector<bool> FitRecording(const MotionData& data, const AnalyseOptions& options,
                               std::size_t stride, MotionAnalysis& analysis);

/// Tells whether every pose has image points, or none has: a reader leaves those out that the joint
/// fit of a very long recording does not take.
bool HasAllPoints(const MotionData& data);

}  // namespace stereomotion
