#pragma once

#include <string>

#include "stereomotion/calibration/calibration.h"
#include "stereomotion/calibration/calibration_setup.h"
#include "stereomotion/io/calibration_json.h"

namespace stereomotion {

/// Writes a finished calibration as a page for people: calibration.html, one file with inline SVG
/// figures, no scripts, nothing from elsewhere. It is well-formed XML, too.
///
/// Big calibrations are thinned where they are drawn (the page says so), never where they are
/// counted. Equal input gives equal bytes. Throws std::invalid_argument as `CalibrationJson`.
std::string CalibrationHtml(const Calibration& calibration, const CalibrationSetup& setup,
                            const CalibrationInputs& inputs);

}  // namespace stereomotion
