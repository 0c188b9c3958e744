#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "bench/accuracy_condition.h"
#include "stereomotion/core/sensor_noise.h"
#include "stereomotion/simulation/render.h"

namespace stereomotion::bench {

/// Describes one ball with what stands around and before it.
struct BallScene {
  BallImage ball;
  double background_dn = 0;
  Eigen::Vector2d background_slope_dn_px = Eigen::Vector2d::Zero();
  double blur_px = 0.6;
  /// A half-plane stands before the ball: what lies farther than `edge_px` from the ball's centre
  /// in the direction `edge_angle_rad` is hidden. Infinity: nothing is.
  double edge_px = 1e9;
  double edge_angle_rad = 0;
  double cover_dn = 0;  ///< grey value of the half-plane, over the background

  [[nodiscard]] bool hidden() const { return edge_px < ball.semi_major_px; }
};

/// Renders the mean grey values of a patch of the given size.
MeanImage RenderBallScene(const BallScene& scene, int width_px, int height_px);

/// Holds many balls in one image, each in the middle of a tile of its own.
struct TiledScene {
  MeanImage mean_dn;
  std::vector<BallScene> balls;              ///< centres in coordinates of the whole image
  std::vector<Eigen::Vector2d> along_units;  ///< direction of the smear, or towards what is hidden
};

/// The camera of the study: 12-bit-like noise in 8 bits. Noise of the background is 2.1 DN, so that
/// rounding plays no part; a black level keeps the noise off zero.
SensorNoise StudySensor();

/// Grey value around the balls [DN].
double StudyBackgroundDn();

/// Ball over background [DN] at a signal-to-noise ratio (docs/accuracy.md).
double AmplitudeDn(double snr_db);

/// Renders a tile for every subpixel phase of the condition, smears and edges in all directions.
TiledScene RenderTiles(const Condition& condition, std::uint64_t seed);

}  // namespace stereomotion::bench
