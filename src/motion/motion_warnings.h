#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "stereomotion/motion/analyse_motion.h"

namespace stereomotion {

/// Spells for a person what limits the answer of an analysis: gaps, a free roll, a law that is open
/// or refuted, several axes, a centre known worse than the body is large, a time offset. The joint
/// fit took every `stride`-th pose.
std::vector<std::string> MotionWarnings(const MotionData& data, const MotionAnalysis& analysis,
                                        std::size_t stride);

}  // namespace stereomotion
