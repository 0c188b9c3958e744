#pragma once

#include <Eigen/Core>

#include "bench/accuracy_scene.h"

namespace stereomotion::bench {

/// Computes the Cramér–Rao bound [px²] of a ball's centre, from differences of rendered images.
///
/// Unknowns: u, v, diameter, amplitude, background plane, blur; where the ball is smeared also the
/// smear vector; where it is partly hidden also the edge's distance, direction and grey value.
/// Shading profile known. Noise: Gaussian of the sensor's variance.
Eigen::Matrix2d CenterBound(const BallScene& scene, const SensorNoise& noise);

}  // namespace stereomotion::bench
