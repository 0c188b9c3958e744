#pragma once

#include "motion/local_polynomial.h"
#include "motion/path_roughness.h"
#include "stereomotion/motion/velocity.h"

namespace stereomotion {

/// Estimates the motion at one time of a stretch (its ends included): of all windows and degrees
/// whose squared bias, as `roughness` foretells it, is small against their variance, the one of
/// smallest variance. Status is left open; `window` is zero where there is no answer.
BodyVelocity VelocityAt(const PoseStretch& stretch, const PathRoughness& roughness, double time_s,
                        int max_half_window);

/// Estimates the motion of one frame only, as `EstimateVelocities` does.
BodyVelocity EstimateVelocityOf(const PoseSeries& series, std::size_t frame,
                                const VelocityOptions& options = {});

}  // namespace stereomotion
