#pragma once

#include <vector>

#include "fit_bundle.h"
#include "stereomotion/calibration/calibration.h"

namespace stereomotion {

/// Triangulates points with a finished rig and compares them with their survey. `observations` are
/// the points' sights, whose covariances are true; only points seen by two cameras and more appear.
std::vector<CheckPoint> CheckPoints(const FittedBundle& fit,
                                    const std::vector<BundlePoint>& surveyed,
                                    const std::vector<BundleObservation>& observations);

/// Calibrates `folds` times without a part of the surveyed points and compares those (dealt out in
/// a fixed shuffle). Outliers of the fit stay out of fits, but are compared all the same. Nothing
/// where a part gives no calibration.
std::optional<CrossValidation> CrossValidate(const FittedBundle& fit, int folds);

/// Expects the uncertainty of a ball on a grid through the box that the observed points fill, where
/// two cameras see it.
std::vector<VolumeSigma> MapVolume(const FittedBundle& fit);

}  // namespace stereomotion
