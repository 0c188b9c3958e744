#pragma once

#include <vector>

#include "fit_bundle.h"
#include "stereomotion/calibration/target_observation.h"

namespace stereomotion {

/// Estimates the radius [mm] of a grid's circles from how large they look where a first fit puts
/// them: median over all images. 0 where no diameter was observed.
double EstimateCircleRadius(const FittedBundle& fit,
                            const std::vector<TargetObservation>& observations);

}  // namespace stereomotion
