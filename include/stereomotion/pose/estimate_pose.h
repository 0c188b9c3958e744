#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "stereomotion/camera/rig.h"
#include "stereomotion/core/body.h"
#include "stereomotion/core/expected.h"
#include "stereomotion/detection/ball_observation.h"
#include "stereomotion/pose/pose_estimate.h"

namespace stereomotion {

/// Says that detection `detection` of camera `camera` (0 left, 1 right) is ball `id`.
struct BallAssignment {
  BallId id;
  int camera = 0;
  int detection = -1;
};

struct PoseOptions {
  double reject_sigma =
      5;  ///< observations farther off than this (in σ × robust scale) are dropped
  int max_iterations = 30;
  int min_balls = 4;  ///< distinct balls; one less for a body on one line (one unknown less)
  /// Residuals larger than this mean that balls are mistaken, not that the rig is a little wrong.
  double max_rms_px = 1.0;
  /// Where the residuals exceed the noise, something is not modelled (a rig from a real calibration
  /// may well be 40 σ wrong). If as noise it would place a ball no better than this (σ, seen in the
  /// images), too little is left to tell a wrong pose.
  double max_doubt_px = 1.0;
  /// Least share of a ball's measurement that the other balls must check. An error that just
  /// escapes `reject_sigma` moves the pose by at most reject_sigma × √((1 − share) / share) σ.
  double min_redundancy = 0.05;
};

/// Finds the transform that places all balls of the body: `world_from_body`, but for a free axis,
/// where the estimate's translation is the first ball's position.
Rigid3 BodyPlacement(const Body& body, const PoseEstimate& pose);

/// Estimates the pose of `body` from assigned detections of both cameras.
///
/// Maximum likelihood over all 2D observations: Gauss–Newton (Levenberg steps while far off) on the
/// outline centres, whitened by their covariances; the perspective shift of each sphere is part of
/// the predicted observation (`ProjectSphere`). Gross errors are dropped worst first against a
/// robust scale of the residuals (1 or more: a wrong rig inflates all residuals alike and is no
/// reason to drop them); `used` receives the assignments that stayed. The covariance is the inverse
/// of the whitened Hessian, never damped. Only observations with status kOk and a positive definite
/// covariance count.
///
/// kTooFewBalls: fewer than `min_balls`, too few to say which ones are false, or one ball alone
/// decides on some direction
/// (`min_redundancy`). kRollUndetermined: all used balls lie on one line, the body's do not. kLost:
/// no convergence, more than half of the observations are gross errors, or residuals beyond
/// `max_rms_px` or `max_doubt_px`. Throws std::invalid_argument for assignments that name nothing
/// and bad options. All balls of the body on one line: the axis is free, see `PoseEstimate`; the
/// rotation is then the smallest from `initial`.
Expected<PoseEstimate, PoseStatus> EstimatePose(
    const RigCamera& left, const RigCamera& right, const Body& body,
    const std::vector<BallObservation>& left_balls, const std::vector<BallObservation>& right_balls,
    const std::vector<BallAssignment>& assignments, const Rigid3& initial_world_from_body,
    const PoseOptions& options = {}, std::vector<BallAssignment>* used = nullptr);

/// Propagates a rig's covariance and the body's (`CovarianceOfBalls`) to the pose's common standard
/// uncertainty (δθ [rad], δt [mm]), first order: ∂pose/∂c = −H⁻¹ JᵀW ∂r/∂c. `left`/`right` index
/// the rig's cameras; the rows of other cameras, and of a rig without covariance, count nothing.
/// Zero about a free axis.
Vector6d CalibrationUncertainty(const Rig& rig, int left, int right, const Body& body,
                                const std::vector<BallObservation>& left_balls,
                                const std::vector<BallObservation>& right_balls,
                                const std::vector<BallAssignment>& used, const PoseEstimate& pose);

}  // namespace stereomotion
