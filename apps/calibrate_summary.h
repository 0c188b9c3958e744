#pragma once

#include <string>

#include "stereomotion/calibration/calibration.h"

namespace stereomotion::app {

/// Spells what a calibration found, for the terminal: cameras with uncertainties, residuals, the
/// expected accuracy in the volume, check points.
std::string CalibrationSummary(const Calibration& calibration);

/// RMS of the check points' 3D error [mm]; 0 without any.
double CheckPointsRmsMm(const Calibration& calibration);

}  // namespace stereomotion::app
