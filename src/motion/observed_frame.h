#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "motion/point_residual.h"
#include "stereomotion/motion/motion_data.h"

namespace stereomotion {

/// Holds what was observed in one measured frame, ready for least squares.
struct ObservedFrame {
  std::size_t index = 0;                 ///< into `MotionData::frames`
  double time_s = 0;                     ///< after the first frame of the data
  Rigid3 world_from_body;                ///< measured, or where the estimation starts
  std::vector<PointObservation> points;  ///< none: the pose is the observation
  /// Square root of the pose's information, k×6, for the left perturbation (δθ, δt): six rows, or
  /// five where the rotation about a free axis is open. Empty where there are points.
  Eigen::MatrixXd pose_whitener;
};

/// Holds the whitened residuals of a frame and how they change with its pose.
struct FrameEquations {
  Eigen::VectorXd residual;
  Eigen::Matrix<double, Eigen::Dynamic, 6> d_pose;  ///< left perturbation (δθ, δt)
  /// Ball of every row, −1 where there is none. A row changes with its ball's place in the body by
  /// its δt columns times R.
  std::vector<int> balls;
};

/// Prepares all measured frames. Throws std::invalid_argument for times that do not ascend, points
/// that break `ObservationsOf`'s rules, or a pose's covariance that is not positive definite (but
/// for its free axis).
std::vector<ObservedFrame> ObservedFrames(const MotionData& data);

/// Factors a pose's information: L⁻¹ of its covariance L Lᵀ, without the free axis.
Eigen::MatrixXd PoseWhitener(const PoseSample& pose);

/// Compares a frame's observations with a pose; nothing where a camera cannot see a ball.
std::optional<FrameEquations> Compare(const ObservedFrame& frame, const Rigid3& world_from_body,
                                      const std::vector<Eigen::Vector3d>& balls_in_body_mm);

}  // namespace stereomotion
