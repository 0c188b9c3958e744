#pragma once

#include <Eigen/Core>

namespace stereomotion {

/// Says whether a detected blob is a measured ball, and if not why (words: docs/formats.md).
enum class BlobStatus {
  kOk,         ///< measured: centre and covariance hold
  kPartly,     ///< looks like a partly hidden, overlapping or merged ball: centre is only rough
  kClipped,    ///< touches the image border
  kSaturated,  ///< too few uncensored pixels for a fit
  kPoorFit,    ///< the ball model does not explain the pixels (χ²)
};

/// Holds one bright blob that was taken for a ball, as one image shows it.
struct BallObservation {
  Eigen::Vector2d center_px = Eigen::Vector2d::Zero();  ///< centre of the ball's outline
  /// Random covariance of `center_px` [px²]: inverse Fisher information under the noise model.
  Eigen::Matrix2d covariance_px2 = Eigen::Matrix2d::Zero();
  double semi_major_px = 0;  ///< of the outline
  double semi_minor_px = 0;
  double angle_rad = 0;     ///< of the major axis, from +u towards +v
  double blur_px = 0;       ///< standard deviation of the optical blur
  double amplitude_dn = 0;  ///< ball over background
  double background_dn = 0;
  double chi2_dof = 0;          ///< χ² per degree of freedom of the fit
  double visible_fraction = 1;  ///< share of the outline's area that is bright
  /// Straight path of the centre over the exposure [px], its sign open; zero where no smear was
  /// evident. `center_px` is the mean over the exposure.
  Eigen::Vector2d smear_px = Eigen::Vector2d::Zero();
  BlobStatus status = BlobStatus::kOk;

  [[nodiscard]] double diameter_px() const { return semi_major_px + semi_minor_px; }
};

}  // namespace stereomotion
