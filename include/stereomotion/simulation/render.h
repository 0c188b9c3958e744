#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "stereomotion/core/image.h"
#include "stereomotion/core/sensor_noise.h"
#include "stereomotion/simulation/sensor.h"

namespace stereomotion {

/// Describes the image of one ball: a shaded ellipse that stands on the background.
struct BallImage {
  Eigen::Vector2d center_px = Eigen::Vector2d::Zero();
  double semi_major_px = 5;
  double semi_minor_px = 5;
  double angle_rad = 0;       ///< of the major axis, from +u towards +v
  double amplitude_dn = 150;  ///< ball's middle over background
  /// Falloff q to the limb: I = background + A (1 − q (1 − √(1 − ρ²))), ρ = 1 at the outline. A
  /// ball whose own light falls by 15 % has q = 0.15 (A + background) / A.
  double shading = 0.165;
  Eigen::Vector2d smear_px = Eigen::Vector2d::Zero();  ///< straight path over the exposure
};

/// Makes a round ball of the given diameter.
inline BallImage RoundBall(const Eigen::Vector2d& center_px, double diameter_px,
                           double amplitude_dn) {
  BallImage ball;
  ball.center_px = center_px;
  ball.semi_major_px = ball.semi_minor_px = diameter_px / 2;
  ball.amplitude_dn = amplitude_dn;
  return ball;
}

struct RenderOptions {
  int width_px = 64;
  int height_px = 64;
  double background_dn = 15;  ///< at the image's middle
  Eigen::Vector2d background_slope_dn_px = Eigen::Vector2d::Zero();
  double blur_px = 0.6;   ///< standard deviation of the optics' Gaussian blur, before the pixels
  int supersampling = 8;  ///< light cells a pixel and axis; limb cells are divided 4 × 4 once more
  std::optional<SensorNoise> noise;  ///< nothing: no noise, only rounding
  std::uint64_t seed = 1;
  int bits = 8;  ///< 8: kGray8, 9 to 16: kGray16
};

/// Renders mean grey values: exact area coverage, Gaussian blur, then integration over each pixel's
/// square. Overlapping balls add up. For semi-axes
/// ≥ 1.5 px the error of a ball's light is ≤ 2e-4 of it, of its centroid ≤ 2e-4 px (tested). Throws
/// std::invalid_argument on sizes that make no sense.
void RenderMean(const std::vector<BallImage>& balls, const RenderOptions& options,
                MeanImage& mean_dn);

/// Renders balls as a sensor shows them: `RenderMean`, then `Expose`.
void RenderBalls(const std::vector<BallImage>& balls, const RenderOptions& options, Image& image);

}  // namespace stereomotion
