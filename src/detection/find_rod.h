#pragma once

#include "ball_model.h"
#include "rod_model.h"
#include "stereomotion/core/sensor_noise.h"

namespace stereomotion {

/// Guesses from the residuals of a ball's fit how a rod might run through it: the direction in
/// which the pixels around the ball differ most from the background, and whether they do so on both
/// sides. `patch` holds the fit's prediction and weights. False: nothing stands out.
bool FindRod(const BallModel& ball, const BallPatch& patch, RodModel& rod);

}  // namespace stereomotion
