#pragma once

#include <Eigen/Core>

#include "ball_model.h"
#include "stereomotion/core/sensor_noise.h"

namespace stereomotion {

/// Holds the outcome of one maximum-likelihood fit.
struct BallFit {
  BallModel model;
  bool converged = false;
  double chi2 = 0;
  int dof = 0;
  int iterations = 0;
  /// Share of the pixels inside the outline that are bright, what noise dims or brightens
  /// accounted for; and its standard deviation by noise.
  double visible_fraction = 1, visible_sigma = 0;
  /// Inverse Fisher information, smear and light marginalised.
  BallModel::Matrix covariance = BallModel::Matrix::Zero();
};

/// Fits the ball model to the patch by Levenberg–Marquardt (see `LinearizeBall` for the
/// likelihood).
///
/// Starts from `initial`, which must lie within about a radius. The blur of a ball that does not
/// tell it stays at `kUsualBlur_px`. A straight smear and uneven light join the model where the
/// data call for them (`ball_evidence.h`); a smear is tried at once where `initial` has one. The
/// covariance is that of the undamped problem and holds no prior; that of the centre has the
/// second-order term, which a ball of 10 dB feels.
BallFit FitBall(const SensorNoise& noise, const BallModel& initial, BallPatch& patch);

}  // namespace stereomotion
