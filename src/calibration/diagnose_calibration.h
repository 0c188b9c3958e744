#pragma once

#include <optional>
#include <vector>

#include "fit_bundle.h"
#include "stereomotion/calibration/calibration.h"
#include "stereomotion/calibration/calibration_setup.h"
#include "stereomotion/calibration/target_observation.h"

namespace stereomotion {

/// Says what a person should know about a finished calibration: outliers, weak directions, units,
/// views, coverage, residuals that are not noise. One note a matter; names: docs/formats.md.
std::vector<CalibrationNote> DiagnoseCalibration(const CalibrationSetup& setup,
                                                 const std::vector<TargetObservation>& observations,
                                                 const FittedBundle& fit);

/// Says where lengths cannot be in millimetres (`wrong_units`): balls that look five times as wide
/// or narrow as they should, or cameras a centimetre or a kilometre away.
std::optional<CalibrationNote> RefuseUnits(const CalibrationSetup& setup,
                                           const std::vector<TargetObservation>& observations,
                                           const FittedBundle& fit);

/// Distance of an observed point from its camera, along the optical axis.
double DepthMm(const FittedBundle& fit, const BundleObservation& observation);

// Its parts that look at one matter each.
void NoteOutliers(const CalibrationSetup& setup, const FittedBundle& fit,
                  std::vector<CalibrationNote>& notes);
void NoteViews(const CalibrationSetup& setup, const std::vector<TargetObservation>& observations,
               const FittedBundle& fit, std::vector<CalibrationNote>& notes);
void NoteWeakDirections(const FittedBundle& fit, std::vector<CalibrationNote>& notes);
void NoteUnits(const CalibrationSetup& setup, const std::vector<TargetObservation>& observations,
               const FittedBundle& fit, std::vector<CalibrationNote>& notes);
void NoteResiduals(const CalibrationSetup& setup, const FittedBundle& fit,
                   std::vector<CalibrationNote>& notes);

}  // namespace stereomotion
