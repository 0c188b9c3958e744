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
  double visible_fraction = 1;   ///< share of the pixels inside the outline that are bright
  BallModel::Matrix covariance;  ///< inverse Fisher information
};

/// Fits the ball model to the patch by Levenberg–Marquardt with variances from the model itself
/// (iteratively reweighted: quasi-likelihood of the sensor noise, McCullagh & Nelder 1989, ch. 9).
/// The covariance is that of the undamped problem. `initial` must lie within about a radius.
BallFit FitBall(const SensorNoise& noise, const BallModel& initial, BallPatch& patch);

}  // namespace stereomotion
