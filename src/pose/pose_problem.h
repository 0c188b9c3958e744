#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "stereomotion/camera/rig.h"
#include "stereomotion/core/body.h"
#include "stereomotion/detection/ball_observation.h"
#include "stereomotion/pose/estimate_pose.h"

namespace stereomotion {

/// Holds one outline centre that may carry the pose.
struct PoseObservation {
  BallAssignment assignment;
  const RigCamera* camera = nullptr;
  Eigen::Vector3d p_in_body_mm;
  double radius_mm = 0;
  Eigen::Vector2d center_px;
  Eigen::Matrix2d whitener;  ///< L⁻¹ of the covariance L Lᵀ [1/px]
  bool active = true;        ///< false: rejected
};

/// Holds what the solver varies: the rotation, and where the pivot is. The pivot lies among the
/// balls (or is the first ball, where the roll is free), so that both are well conditioned whatever
/// the body frame's origin is.
struct PoseState {
  Eigen::Quaterniond rotation;
  Eigen::Vector3d pivot_in_world_mm;
};

/// Holds an estimation problem: the observations and the parametrisation.
struct PoseProblem {
  std::vector<PoseObservation> observations;
  Eigen::Vector3d pivot_in_body_mm;
  std::optional<Eigen::Vector3d> free_axis_in_body;  ///< all balls of the body lie on it
};

/// Holds one observation's residual (predicted − observed) and its derivatives at a state.
struct ObservationFit {
  Eigen::Vector2d residual_px = Eigen::Vector2d::Zero();
  Eigen::Vector2d whitened = Eigen::Vector2d::Zero();
  Eigen::Matrix<double, 2, 6> jacobian;  ///< of `whitened` by (δθ about the pivot, δpivot)
  Eigen::Matrix<double, 2, 3> d_point;   ///< of the prediction by the world point [px/mm]
};

/// Collects the usable observations: status kOk with a positive definite covariance.
/// Throws std::invalid_argument for an assignment that names no ball, camera or detection.
PoseProblem MakePoseProblem(const RigCamera& left, const RigCamera& right, const Body& body,
                            const std::vector<BallObservation>& left_balls,
                            const std::vector<BallObservation>& right_balls,
                            const std::vector<BallAssignment>& assignments);

PoseState StateOf(const PoseProblem& problem, const Rigid3& world_from_body);

/// Compares one observation with its prediction: projection of the ball's centre + the shift of its
/// outline. The shift (thousandths of a pixel) is taken as constant in the derivative. Nothing
/// where the camera cannot see the ball.
std::optional<ObservationFit> FitObservation(const PoseProblem& problem,
                                             const PoseObservation& observation,
                                             const PoseState& state);

}  // namespace stereomotion
