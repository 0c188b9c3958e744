#pragma once

#include <Eigen/Core>

#include "fit_ball.h"
#include "part_patch.h"
#include "stereomotion/core/sensor_noise.h"

namespace stereomotion {

/// Holds the straight edge of something dark or bright that hides a part of a ball.
struct CutEdge {
  double angle_rad = 0;    ///< of its normal, towards what hides
  double place_px = 0;     ///< of its points along the normal
  double contrast_dn = 0;  ///< of what hides, against the background
};

/// Holds the fit of a round ball that an edge cuts.
struct CutFit {
  BallFit ball;  ///< dof counts the edge's unknowns; its covariance has them marginalised
  CutEdge edge;
  double cost = 0;          ///< −2 × log-likelihood up to a constant, and what guided the fit
  double hidden_share = 0;  ///< of the ball's area
  double arc_share = 1;     ///< of its limb that is seen
};

/// Fits ball and edge together by Levenberg–Marquardt. The ball is held round (axes within 1 %),
/// which the covariance knows; blur and shading are guided by `initial`, for a dim ball leaves them
/// open. Near the corners of what is seen the product of two blurred edges is only nearly right:
/// beyond some 40 dB χ² shows it.
CutFit FitCutBall(const SensorNoise& noise, const BallModel& initial, const CutEdge& edge,
                  BallPatch& patch);

}  // namespace stereomotion
