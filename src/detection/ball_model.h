#pragma once

#include <Eigen/Core>
#include <vector>

#include "pixel_order.h"
#include "stereomotion/core/sensor_noise.h"

namespace stereomotion {

/// Blur of a usual lens at focus, pixel aperture included.
constexpr double kUsualBlur_px = 0.7;

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
  /// Straight path over the exposure, whose middle is (u, v); zero: none.
  Eigen::Vector2d smear_px = Eigen::Vector2d::Zero();
  /// Change of the amplitude over the ball, relative to that at (u, v) [1/px]; zero: even light.
  Eigen::Vector2d light_per_px = Eigen::Vector2d::Zero();
};

/// Sums up pixels that show the background alone, far from the ball.
struct BackgroundSums {
  void Add(double u, double v, double grey);

  double n = 0, u = 0, v = 0, uu = 0, uv = 0, vv = 0;
  double grey = 0, u_grey = 0, v_grey = 0, grey2 = 0;  ///< [DN, DN²]
};

/// Holds the pixels of one ball's patch, column-wise, in memory that is reused from ball to ball.
struct BallPatch {
  /// Pixels that the fit's loops take at once; columns end in as many spare places.
  static constexpr int kLanes = 16;

  void Resize(int capacity);

  int size = 0;         ///< pixels in use
  Eigen::ArrayXf u, v;  ///< position relative to the patch's origin [px]
  Eigen::ArrayXf grey;  ///< measured [DN]
  BackgroundSums ring;  ///< further pixels, of background alone; only the fit regards them
  // Work memory of `EvaluateBallModel` and `WeighPatch`:
  Eigen::ArrayXf model;            ///< predicted [DN]
  Eigen::ArrayXf depth;            ///< distance inside the limb in units of the blur
  Eigen::ArrayXf weight;           ///< 1 / predicted variance, 0 where censored [1/DN²]
  Eigen::ArrayXXf jacobian;        ///< capacity × kNumParameters, ∂ model / ∂ parameter
  Eigen::ArrayXf work;             ///< one column
  std::vector<float> fit_columns;  ///< work memory of the fit
  PixelOrder order;                ///< that the fit of a smear puts the pixels into
};

/// Predicts the patch's grey values and their derivatives; of a ball without smear in even light.
void EvaluateBallModel(const BallModel& ball, BallPatch& patch);

/// Sets the weights from the predicted grey values; a pixel at saturation or at zero is a bound on
/// its light, not a measurement: its weight is 0 where the prediction lies beyond that bound.
void WeighPatch(const SensorNoise& noise, BallPatch& patch);

}  // namespace stereomotion
