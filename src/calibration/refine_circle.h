#pragma once

#include <Eigen/Core>
#include <optional>

#include "ellipse_model.h"
#include "grey_fit.h"
#include "stereomotion/core/image.h"

namespace stereomotion {

/// Says roughly where a circle is.
struct CircleGuess {
  bool dark = true;  ///< against its surroundings
  Eigen::Vector2d center_px = Eigen::Vector2d::Zero();
  Eigen::Vector2d semi_axes_px = Eigen::Vector2d::Zero();
  double angle_rad = 0;   ///< of the first axis, from +u towards +v
  double spacing_px = 0;  ///< to the nearest other circle's centre
};

/// Holds a fitted circle's image.
struct RefinedCircle {
  EllipseModel model;  ///< black is the circle's level, white that around it
  /// Inverse Fisher information of (u, v) under the stated pixel variance [px²].
  Eigen::Matrix2d covariance_px2 = Eigen::Matrix2d::Zero();
  double chi2_dof = 0;
  LevelNoise noise;
};

/// Fits `EllipseModel` to a circle's grey values by maximum likelihood (`GreyFit`). Nothing where
/// the window leaves the image, or no ellipse explains it.
std::optional<RefinedCircle> RefineCircle(const ImageView& image, const CircleGuess& guess,
                                          double blur_px, const VarianceLine& variance);

}  // namespace stereomotion
