#include "stereomotion/simulation/sensor.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "counter_rng.h"

namespace stereomotion {
namespace {

/// Draws a Poisson number by inversion (product of uniforms would need one draw an electron).
double DrawPoisson(double mean, CounterRng& rng) {
  constexpr double kNormalFrom = 64;
  if (mean <= 0) return 0;
  if (mean > kNormalFrom) {
    return std::max(std::round(mean + std::sqrt(mean) * rng.Normal()), 0.0);
  }
  double left = rng.Uniform();
  double probability = std::exp(-mean);
  int count = 0;
  while (left > probability && probability > 0) {
    left -= probability;
    probability *= mean / ++count;
  }
  return count;
}

double DrawGreyValue(double mean_dn, const SensorNoise& noise, CounterRng rng) {
  const double electrons = DrawPoisson((mean_dn - noise.black_dn) * noise.gain_e_per_dn, rng);
  const double read = noise.read_e > 0 ? noise.read_e * rng.Normal() : 0.0;
  return noise.black_dn + (electrons + read) / noise.gain_e_per_dn;
}

template <class T>
void ExposeAs(const MeanImage& mean_dn, const SensorOptions& options, Image& image) {
  const double top_dn = std::ldexp(1.0, options.bits) - 1;
  for (Eigen::Index v = 0; v < mean_dn.rows(); ++v) {
    T* row = image.Row<T>(static_cast<int>(v));
    for (Eigen::Index u = 0; u < mean_dn.cols(); ++u) {
      double value_dn = mean_dn(v, u);
      if (options.noise) {
        const auto pixel = static_cast<std::uint64_t>(v * mean_dn.cols() + u);
        value_dn = DrawGreyValue(value_dn, *options.noise,
                                 CounterRng(options.seed, options.stream, pixel));
      }
      row[u] = static_cast<T>(std::clamp(std::round(value_dn), 0.0, top_dn));
    }
  }
}

void CheckOptions(const SensorOptions& options) {
  if (options.bits < 8 || options.bits > 16) {
    throw std::invalid_argument("sensor: bits must lie between 8 and 16");
  }
  if (options.noise && !(options.noise->gain_e_per_dn > 0 && options.noise->read_e >= 0)) {
    throw std::invalid_argument("sensor: gain must be positive and read noise not negative");
  }
}

}  // namespace

void Expose(const MeanImage& mean_dn, const SensorOptions& options, Image& image) {
  CheckOptions(options);
  const PixelType type = options.bits == 8 ? PixelType::kGray8 : PixelType::kGray16;
  image.Resize(static_cast<int>(mean_dn.cols()), static_cast<int>(mean_dn.rows()), type);
  if (type == PixelType::kGray8) {
    ExposeAs<std::uint8_t>(mean_dn, options, image);
  } else {
    ExposeAs<std::uint16_t>(mean_dn, options, image);
  }
}

}  // namespace stereomotion
