#pragma once

#include <Eigen/Core>
#include <random>
#include <vector>

#include "stereomotion/core/image.h"
#include "stereomotion/core/sensor_noise.h"

namespace stereomotion::testing {

/// Describes a ball of a `RodScene`; later ones hide earlier ones.
struct SceneBall {
  Eigen::Vector2d center_px;
  double radius_px = 5.4;
  double amplitude_dn = 150;
};

/// Describes a cylindrical rod whose axis runs through the centre of a ball.
struct SceneRod {
  int ball = 0;
  double angle_rad = 0;
  double half_width_px = 1.2;
  double level_dn = 7;
  double tilt_rad = 0;  ///< of the axis towards the camera in the direction of the angle
  bool ahead = true, behind = true;
};

/// Describes a strip that lies before everything: |across| < half_width, along < end.
struct SceneBar {
  Eigen::Vector2d point_px;
  double angle_rad = 0;
  double half_width_px = 3;
  double level_dn = 5;
  double end_px = 1e9;
};

/// Holds balls, rods and bars before an even background, seen from far away.
struct RodScene {
  int width_px = 88;
  int height_px = 48;
  double background_dn = 15;
  double blur_px = 0.6;   ///< of the lens
  double shading = 0.15;  ///< fall of brightness from the middle to the limb
  std::vector<SceneBall> balls;
  std::vector<SceneRod> rods;
  std::vector<SceneBar> bars;
};

/// Renders a scene without any formula of the detector: rays against spheres and cylinders,
/// averaged over cells of 1/6 px, Gaussian blur, the pixel's box, then shot and read noise and
/// quantisation.
Image RenderRodScene(const RodScene& scene, const SensorNoise& noise, std::mt19937_64& rng);

}  // namespace stereomotion::testing
