#pragma once

#include "ball_model.h"
#include "ball_search.h"
#include "fit_ball.h"
#include "stereomotion/core/sensor_noise.h"

namespace stereomotion {

/// Counts which share of the pixels inside the fitted outline reach half the height predicted, what
/// noise dims or brightens accounted for, and how far noise spreads it.
void MeasureVisible(const SensorNoise& noise, const FittedBall& best, const BallPatch& patch,
                    BallFit& fit);

}  // namespace stereomotion
