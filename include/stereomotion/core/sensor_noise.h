#pragma once

namespace stereomotion {

/// Describes the noise of a camera's grey values (EMVA 1288 linear model).
struct SensorNoise {
  double gain_e_per_dn = 50;   ///< electrons per grey value
  double read_e = 10;          ///< standard deviation in darkness, electrons
  double black_dn = 0;         ///< grey value of darkness
  double saturation_dn = 255;  ///< grey values at or above this one are censored

  /// Predicts the variance of a pixel whose mean is `mean_dn` [DN²]: shot noise, read noise and
  /// 1/12 LSB² of quantisation.
  [[nodiscard]] double VarianceDn2(double mean_dn) const {
    const double signal_dn = mean_dn > black_dn ? mean_dn - black_dn : 0.0;
    const double read_dn = read_e / gain_e_per_dn;
    return signal_dn / gain_e_per_dn + read_dn * read_dn + 1.0 / 12.0;
  }
};

}  // namespace stereomotion
