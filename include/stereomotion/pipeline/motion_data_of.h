#pragma once

#include <vector>

#include "stereomotion/motion/motion_data.h"
#include "stereomotion/pipeline/measure.h"
#include "stereomotion/pose/pair_measurement.h"

namespace stereomotion {

/// Collects what was measured of one body as data for the analysis of its motion: poses, and the
/// projections of the balls' centres that carry them. `measurements` may hold other bodies' too;
/// `body` indexes `setup.bodies`. A body of a single rod: coordinates count from its first ball, as
/// its poses do. Throws std::invalid_argument for a body that `setup` does not have.
MotionData MotionDataOf(const MeasureSetup& setup, const std::vector<PairMeasurement>& measurements,
                        int body = 0);

}  // namespace stereomotion
