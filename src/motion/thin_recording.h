#pragma once

#include <cstddef>
#include <vector>

#include "stereomotion/motion/motion_data.h"
#include "stereomotion/motion/spin_center.h"

namespace stereomotion {

/// Finds every `stride`-th frame with a pose, the first one included.
std::vector<std::size_t> EveryNthPose(const MotionData& data, std::size_t stride);

/// Takes these frames of the data.
MotionData FramesAt(const MotionData& data, const std::vector<std::size_t>& kept);

/// Takes the frames up to the `measured`-th one with a pose.
MotionData FirstPart(const MotionData& data, std::size_t measured);

/// Gives a result of thinned data the frames of the whole series: states by the law, which is exact
/// for orders 0 to 2; of a free path only the fitted frames have one. Indices of frames left out
/// become those of the series. Returns which frames have a state.
std::vector<bool> SpreadOverSeries(const PoseSeries& series, const std::vector<std::size_t>& kept,
                                   SpinCenterResult& result);

/// Moves a state by `dt_s` along its law (constant acceleration), with its covariance.
CenterState Propagated(const CenterState& state, double dt_s);

}  // namespace stereomotion
