#pragma once

#include "background_map.h"
#include "stereomotion/core/sensor_noise.h"
#include "variance_line.h"

namespace stereomotion {

/// Adds the variances of the background's cells to the photon transfer line, `noise` being the
/// model so far.
///
/// Cells that show more than noise (edges, balls, rods) are left out. In near darkness the half of
/// the noise that is cut off at grey value 0 is made good; where the noise is so small that
/// rounding to whole grey values distorts it, the cell is linearised about what rounding makes of
/// the expected noise.
void AddBackgroundVariance(const BackgroundMap& map, const SensorNoise& noise, VarianceLine& line);

}  // namespace stereomotion
