#include "variance_line.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace stereomotion {
namespace {

/// Below this slope [1/e⁻ per DN] read noise alone explains the images.
constexpr double kSmallestSlope = 1e-6;

}  // namespace

void VarianceLine::Add(double mean_dn, double variance_dn2, double expected_dn2, int count) {
  const double w = 0.5 * count / (expected_dn2 * expected_dn2);
  const Eigen::Vector2d row(1, mean_dn);
  normal_ += w * row * row.transpose();
  rhs_ += w * variance_dn2 * row;
  scatter_ += count * variance_dn2 / expected_dn2;
  pixels_ += count;
}

void VarianceLine::Add(const VarianceLine& other) {
  normal_ += other.normal_;
  rhs_ += other.rhs_;
  scatter_ += other.scatter_;
  pixels_ += other.pixels_;
}

double VarianceLine::MeanScatter() const { return scatter_ / std::max(pixels_, 1); }

std::optional<SensorNoise> VarianceLine::ToNoise(double saturation_dn) const {
  const Eigen::Vector2d line = normal_.ldlt().solve(rhs_);
  if (!line.allFinite()) return std::nullopt;
  SensorNoise noise;
  noise.saturation_dn = saturation_dn;
  noise.gain_e_per_dn = 1 / std::max(line[1], kSmallestSlope);
  const double read_dn2 = line[0] - 1.0 / 12.0;
  if (read_dn2 >= 0) {
    noise.read_e = std::sqrt(read_dn2) * noise.gain_e_per_dn;
  } else {
    // The line meets the quantisation floor above grey value 0: that is where darkness lies.
    noise.read_e = 0;
    noise.black_dn = -read_dn2 * noise.gain_e_per_dn;
  }
  return noise;
}

}  // namespace stereomotion
