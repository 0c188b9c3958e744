#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "corner_model.h"
#include "grey_fit.h"
#include "stereomotion/core/image.h"

namespace stereomotion {

/// Says roughly where a corner is, and how far around it nothing else is printed.
struct CornerGuess {
  int point = -1;  ///< index into `Target::points`
  CornerShape shape = CornerShape::kWedge;
  Eigen::Vector2d pixel_px = Eigen::Vector2d::Zero();
  /// Wedge: from the corner along black's edges; saddle: along both lines, black between the arms.
  std::array<Eigen::Vector2d, 2> arms_px;
  /// How long the edges are along the arms, and how far across them the next print begins.
  std::array<double, 2> along_px = {0, 0}, across_px = {0, 0};
  std::array<Eigen::Vector2d, 2> curvature = {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
};

/// Holds a fitted corner.
struct RefinedCorner {
  CornerModel model;
  /// Inverse Fisher information of (u, v) under the stated pixel variance [px²].
  Eigen::Matrix2d covariance_px2 = Eigen::Matrix2d::Zero();
  double chi2_dof = 0;
  LevelNoise noise;
};

/// Says what of its surroundings a corner is fitted to.
struct CornerWindow {
  double blur_px = 0.8;      ///< start value; the band across the edges is a few of it wide
  double max_along_px = 24;  ///< of the edges
  VarianceLine variance;
};

/// Fits `CornerModel` to the grey values along both edges by maximum likelihood (`GreyFit`).
/// Nothing where the window leaves the image, or no corner explains it.
std::optional<RefinedCorner> RefineCorner(const ImageView& image, const CornerGuess& guess,
                                          const CornerWindow& window);

}  // namespace stereomotion
