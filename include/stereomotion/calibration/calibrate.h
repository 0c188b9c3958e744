#pragma once

#include <functional>
#include <string>
#include <vector>

#include "stereomotion/calibration/calibration.h"
#include "stereomotion/calibration/calibration_setup.h"
#include "stereomotion/calibration/target_observation.h"
#include "stereomotion/core/expected.h"

namespace stereomotion {

struct CalibrateOptions {
  /// The observations' covariances are true standard uncertainties; false: they are weights, and
  /// their scale is estimated. Balls: true. Corners: false.
  bool image_sigma_known = true;
  int folds = 5;  ///< of the cross-validation over control points; 0: none
  std::function<void(const std::string&)> progress;  ///< told what is done next; may be empty
};

/// Calibrates N ≥ 2 cameras from what they saw of a target: first values, robust bundle adjustment,
/// covariance, check points, cross-validation, warnings.
///
/// The world is the surveyed points' (or the axes that `setup.world` lays through them), the board
/// in the first view that was seen, or for a wand the first camera. Deterministic. Where the data
/// give no calibration, the note says why.
Expected<Calibration, CalibrationNote> Calibrate(const CalibrationSetup& setup,
                                                 const std::vector<TargetObservation>& observations,
                                                 const CalibrateOptions& options = {});

}  // namespace stereomotion
