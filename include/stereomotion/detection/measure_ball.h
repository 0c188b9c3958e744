#pragma once

#include <Eigen/Core>
#include <optional>

#include "stereomotion/core/image.h"
#include "stereomotion/core/sensor_noise.h"
#include "stereomotion/detection/ball_observation.h"

namespace stereomotion {

/// Describes what the balls of an image have in common, as `BallObservation` counts it.
struct BallShape {
  double radius_px = 0;  ///< of the outline
  double blur_px = 0;    ///< standard deviation of the optical blur
};

struct MeasureBallOptions {
  double max_shift_px = 3;      ///< the centre found must lie this near to the place given
  double min_significance = 6;  ///< of the amplitude, in its own standard deviations
};

/// Measures one ball whose place, size and blur are known roughly: dim, glinting or scratched ones
/// that the detector misses or flags.
///
/// Centre, amplitude and background plane are fitted to the round ball of known shape by a
/// redescending M-estimator (Cauchy's weights at 95 % Gaussian efficiency; Holland & Welsch 1977):
/// a glint inside the ball is an outlier of some pixels, while the rest of the limb still tells
/// the centre. Pixels far brighter than the ball (10 σ), with those that the blur lights around
/// them, are left out altogether. The covariance is Huber's (1981, ch. 7): the inverse Fisher
/// information times mean ψ² / (mean ψ')² over the ball's pixels, not less than the estimator's
/// loss under pure noise; so it grows with what the model does not explain. `chi2_dof` is that of
/// the pixels kept. A glint too weak to be told from uneven paint still draws the centre, unseen by
/// the covariance.
///
/// Nothing where the ball would touch the border, where it is too faint, where the fit leads away
/// from `place_px` or does not converge. Throws std::invalid_argument for a radius or noise that
/// is not positive.
std::optional<BallObservation> MeasureBall(const ImageView& image, const SensorNoise& noise,
                                           const Eigen::Vector2d& place_px, const BallShape& shape,
                                           const MeasureBallOptions& options = {});

}  // namespace stereomotion
