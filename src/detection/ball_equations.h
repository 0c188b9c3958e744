#pragma once

#include <Eigen/Core>

#include "ball_model.h"
#include "gauss_legendre.h"
#include "stereomotion/core/sensor_noise.h"

namespace stereomotion {

/// Spells a ball with all that the data may call for as one vector: `BallModel::values`, then smear
/// and light.
struct FitParameters {
  static constexpr int kNum = 15;
  enum { kSmearU = BallModel::kNumParameters, kSmearV, kLightU, kLightV };
  using Vector = Eigen::Matrix<double, kNum, 1>;
  using Matrix = Eigen::Matrix<double, kNum, kNum>;

  static Vector FromModel(const BallModel& ball);
  static BallModel ToModel(const Vector& values);
};

/// Holds a patch's likelihood at one place in the space of parameters, to second order.
struct BallEquations {
  /// Information: expected, of censored pixels observed.
  FitParameters::Matrix hessian = FitParameters::Matrix::Zero();
  FitParameters::Vector gradient = FitParameters::Vector::Zero();  ///< of the log-likelihood
  double deviance = 0;  ///< −2 × quasi-log-likelihood, up to a constant
  double chi2 = 0;      ///< Σ residual² / variance
  int used = 0;         ///< pixels in χ²
};

/// Evaluates the patch (columns and ring) at `ball`: the first `num_active` parameters, either
/// `BallModel::kNumParameters` or all.
///
/// The score of a pixel is (measured − model) / V(model), the quasi-likelihood of noise whose
/// variance V is linear in the mean (McCullagh & Nelder 1989, ch. 9). At saturation or at zero it
/// is the score of P(value ≥ saturation − 1/2) or of P(value ≤ 1/2) for normal noise: what rounding
/// leaves of the grey value. `num_nodes`: instants that a smear is summed up from; 0: as many as it
/// needs.
void LinearizeBall(const SensorNoise& noise, const FitParameters::Vector& ball, int num_active,
                   BallPatch& patch, BallEquations& equations, int num_nodes = 0);

/// Points at the columns that `LinearizeBall` left: derivatives, then residuals at `num_active`,
/// all divided by the noise's standard deviation. `LinearizedSize` rows, those beyond the patch
/// zero.
float* LinearizedColumn(BallPatch& patch, int k);
int LinearizedSize(const BallPatch& patch);

}  // namespace stereomotion
