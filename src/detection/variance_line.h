#pragma once

#include <Eigen/Core>
#include <optional>

#include "stereomotion/core/sensor_noise.h"

namespace stereomotion {

/// Gathers measured variances at many grey values and fits the line variance = intercept + slope ×
/// mean, the photon transfer curve (EMVA 1288). Weights are 1/(2 σ⁴), those of squared normal
/// residuals.
class VarianceLine {
 public:
  /// Adds the mean of `count` independent squared residuals; `expected_dn2` is the variance under
  /// the noise model so far.
  void Add(double mean_dn, double variance_dn2, double expected_dn2, int count = 1);
  void Add(const VarianceLine& other);

  [[nodiscard]] int pixels() const { return pixels_; }
  /// Mean of variance / expected variance.
  [[nodiscard]] double MeanScatter() const;
  /// Turns the fitted line into the sensor's terms.
  [[nodiscard]] std::optional<SensorNoise> ToNoise(double saturation_dn) const;

 private:
  Eigen::Matrix2d normal_ = Eigen::Matrix2d::Zero();
  Eigen::Vector2d rhs_ = Eigen::Vector2d::Zero();
  double scatter_ = 0;
  int pixels_ = 0;
};

}  // namespace stereomotion
