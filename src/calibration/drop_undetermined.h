#pragma once

#include <vector>

#include "fit_bundle.h"
#include "stereomotion/calibration/calibration.h"

namespace stereomotion {

/// Finds distortion coefficients that the images leave open: estimated as not different from zero
/// (4 σ) while their σ alone would move the image's corner further than a usual lens' own value
/// does. Kept in the fit they bend it far from any ellipsoid, and the rig goes wild beyond the
/// points; the true value is a part of such a σ.
///
/// Returns whether there are any. Then `problem` no longer estimates the highest of each camera: it
/// gets the value in `kept`, the cameras as they were before anything was found, as do the start
/// values of that camera's other coefficients. `notes` says so (`distortion_undetermined`).
bool DropUndetermined(const FittedBundle& fit, const std::vector<RigCamera>& kept,
                      BundleProblem& problem, std::vector<CalibrationNote>& notes);

}  // namespace stereomotion
