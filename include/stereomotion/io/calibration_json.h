#pragma once

#include <string>
#include <vector>

#include "stereomotion/calibration/calibration.h"
#include "stereomotion/calibration/calibration_setup.h"
#include "stereomotion/io/run_record.h"

namespace stereomotion {

/// Says where a calibration's data come from. What is not known is left empty.
struct CalibrationInputs {
  std::string version;
  std::vector<std::string> command;
  std::string date;  ///< ISO 8601, UTC; from the caller, so that equal input gives equal bytes
  std::vector<RunInput> files;                   ///< with their hashes
  std::vector<std::vector<std::string>> images;  ///< file names, [camera][view]
  /// Width of the edges in each image, a Gaussian's σ (median over its points), [camera][view]; 0:
  /// unknown.
  std::vector<std::vector<double>> blur_px;
};

/// Spells a finished calibration as calibration.json (format stereomotion-calibration/1, see
/// docs/formats.md): every number of the report and all residuals. What is not known is null.
///
/// Equal input gives equal bytes, whatever the locale. Throws std::invalid_argument where the
/// arguments do not belong together.
std::string CalibrationJson(const Calibration& calibration, const CalibrationSetup& setup,
                            const CalibrationInputs& inputs);

}  // namespace stereomotion
