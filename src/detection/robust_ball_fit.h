#pragma once

#include <Eigen/Core>
#include <optional>

#include "ball_model.h"
#include "stereomotion/core/sensor_noise.h"

namespace stereomotion {

/// Holds the M-estimate of a ball of known radius, blur and shading.
struct RobustBallFit {
  BallModel model;
  Eigen::Matrix2d center_covariance_px2;  ///< Huber's, see `MeasureBall`
  double amplitude_sigma_dn = 0;
  double chi2_dof = 0;
};

/// Fits centre, amplitude and background plane to the patch from `initial` with Cauchy's weights;
/// the pixels of glints are removed from the patch on the way. Nothing where the centre moves more
/// than `max_shift_px`, the ball turns dark or the search does not converge.
std::optional<RobustBallFit> FitBallRobustly(const SensorNoise& noise, const BallModel& initial,
                                             double max_shift_px, BallPatch& patch);

}  // namespace stereomotion
