#pragma once

namespace stereomotion {

/// Undoes the pull of blur and filters on a round limb.
///
/// A disc of radius R under a Gaussian blur σ has the slope exp(−(r² + R²)/2σ²) I₁(rR/σ²) R/σ²; the
/// product of two scales is steepest where Σ (R I₀/I₁ − r)/σ² = 2/r. Given r, this iterates for R.
double UnbiasedRadius(double radius_px, double blur_px);

}  // namespace stereomotion
