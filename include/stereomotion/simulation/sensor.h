#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "stereomotion/core/image.h"
#include "stereomotion/core/sensor_noise.h"

namespace stereomotion {

/// Holds the mean grey values [DN] that the light gives, before noise and quantisation; row v,
/// column u.
using MeanImage = Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct SensorOptions {
  /// Shot and read noise; nothing: a perfect sensor that only rounds. `saturation_dn` and
  /// `black_dn` belong to the caller's analysis: the sensor clips at 0 and 2^bits − 1.
  std::optional<SensorNoise> noise;
  int bits = 8;  ///< 8, or 9 to 16 (stored as 16-bit grey values, not shifted)
  std::uint64_t seed = 1;
  std::uint64_t stream = 0;  ///< frame and camera: other streams of one seed are independent
};

/// Turns mean grey values into an image as a sensor would: Poisson electrons, Gaussian read noise,
/// rounding, clipping.
///
/// Each pixel draws from its own counter (seed, stream, pixel number), so that the image does not
/// depend on the order or the number of threads. Above 64 electrons a rounded normal number stands
/// for the Poisson one (equal in mean and variance).
void Expose(const MeanImage& mean_dn, const SensorOptions& options, Image& image);

}  // namespace stereomotion
