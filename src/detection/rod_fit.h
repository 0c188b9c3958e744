#pragma once

#include "ball_model.h"
#include "fit_ball.h"
#include "rod_model.h"
#include "stereomotion/core/sensor_noise.h"

namespace stereomotion {

/// Holds the joint fit of a ball and the rod that it is threaded on.
struct RodFit {
  BallFit ball;  ///< its covariance has the rod's parameters marginalised; dof counts them
  RodModel rod;

  [[nodiscard]] bool has_rod() const { return rod.ahead || rod.behind; }
};

/// Holds the shape that balls of an image usually have, to guide a search that sees a part only.
struct UsualBall {
  double radius_px = 0;  ///< the model's
  double blur_px = 0;    ///< the model's
  double amplitude_dn = 0;
  double radius_spread_px = 0;  ///< standard deviation from ball to ball
  /// Counts the shape as an observation, with its spread, in the covariance too; for balls of which
  /// too little is seen to tell their shape.
  bool counts = false;
};

/// Fits ball and rod together by Levenberg–Marquardt, as `FitBall` fits the ball alone; the ball
/// alone where the rod has no side. `initial` must lie near: the ball as it was fitted without the
/// rod, the rod's angle within some 15°. `usual`, where given, holds radius, blur and roundness
/// near; the covariance takes no notice of it unless it `counts`.
RodFit FitBallWithRod(const SensorNoise& noise, const BallModel& initial_ball,
                      const RodModel& initial_rod, BallPatch& patch, RodPatch& rod_patch,
                      const UsualBall* usual = nullptr, int max_iterations = 30);

}  // namespace stereomotion
