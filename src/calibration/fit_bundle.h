#pragma once

#include "stereomotion/calibration/adjust_bundle.h"
#include "stereomotion/core/expected.h"

namespace stereomotion {

struct FitOptions {
  /// The observations' covariances are true (balls under a noise model), not mere weights
  /// (corners): then their scale is touched only where χ² refutes it.
  bool image_sigma_known = true;
};

/// Holds an adjustment that has found its outliers and its variance components. The problem's
/// covariances and σ have been multiplied by the scales.
struct FittedBundle {
  BundleProblem problem;
  BundleSolution solution;
  double image_sigma_scale = 1;
  double survey_sigma_scale = 1;
};

/// Adjusts a bundle robustly: Huber's weights against a robust scale first, then observations
/// beyond a gate are left out (`used`), then least squares with variance components for image and
/// survey (Förstner 1979; Helmert), each used only where χ² refutes the stated one at 99.9 %.
Expected<FittedBundle, BundleFailure> FitBundle(const BundleProblem& problem,
                                                const FitOptions& options);

/// Tells whether χ² with `redundancy` degrees of freedom is beyond the two-sided 99.9 % interval
/// (Wilson & Hilferty 1931); never with fewer than 5.
bool RefutesUnitVariance(double chi2, double redundancy);

}  // namespace stereomotion
