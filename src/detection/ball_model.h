#pragma once

#include <Eigen/Core>

#include "stereomotion/core/sensor_noise.h"

namespace stereomotion {

/// Holds the parameters of one ball's image; pixel coordinates are relative to the patch's origin.
struct BallModel {
  static constexpr int kNumParameters = 11;
  enum Parameter {
    kU,
    kV,
    kRadius,
    kStretch1,
    kStretch2,
    kBlur,
    kAmplitude,
    kShading,
    kLevel,
    kSlopeU,
    kSlopeV
  };
  using Vector = Eigen::Matrix<double, kNumParameters, 1>;
  using Matrix = Eigen::Matrix<double, kNumParameters, kNumParameters>;

  /// u, v [px]; radius [px]; stretch1, stretch2: the outline is
  /// (1 − 2 e1) x² + (1 + 2 e1) y² − 4 e2 x y = R²; blur [px], pixel aperture included; amplitude
  /// [DN]; limb shading q (amplitude × (1 − q + q μ)); background level [DN] and slopes [DN/px].
  Vector values = Vector::Zero();
};

/// Holds the pixels of one ball's patch, column-wise, in memory that is reused from ball to ball.
struct BallPatch {
  void Resize(int capacity);

  int size = 0;         ///< pixels in use
  Eigen::ArrayXf u, v;  ///< position relative to the patch's origin [px]
  Eigen::ArrayXf grey;  ///< measured [DN]
  // Work memory of the fit:
  Eigen::ArrayXf model;      ///< predicted [DN]
  Eigen::ArrayXf depth;      ///< distance inside the limb in units of the blur
  Eigen::ArrayXf weight;     ///< 1 / predicted variance, 0 where censored [1/DN²]
  Eigen::ArrayXXf jacobian;  ///< capacity × kNumParameters, ∂ model / ∂ parameter
  Eigen::ArrayXf work;       ///< one column
};

/// Predicts the patch's grey values and their derivatives.
void EvaluateBallModel(const BallModel& ball, BallPatch& patch);

/// Sets the weights from the predicted grey values; a pixel at saturation or at zero is a bound on
/// its light, not a measurement: its weight is 0 where the prediction lies beyond that bound.
void WeighPatch(const SensorNoise& noise, BallPatch& patch);

}  // namespace stereomotion
