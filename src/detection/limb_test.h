#pragma once

#include "ball_model.h"
#include "fit_ball.h"
#include "stereomotion/core/sensor_noise.h"

namespace stereomotion {

/// Tests whether a fitted ball's limb bulges where neither ball nor smear can: by the odd harmonics
/// 3 and 5 of its outline, which are zero for every outline that is symmetric about its centre. A
/// hidden part, a rod and a glint at the limb show there, even where stretch and smear took them
/// in. Gives χ² of four degrees of freedom (score test; Rao 1948), the centre being free.
///
/// `patch`: as the fit left it, with its prediction and depth.
double LimbAsymmetry(const SensorNoise& noise, const BallFit& fit, BallPatch& patch);

}  // namespace stereomotion
