#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "stereomotion/motion/motion_data.h"

namespace stereomotion {

/// Holds one observed ball, made ready for least squares. Image and space points look alike: three
/// rows, of which an image point leaves the third at zero.
struct PointObservation {
  int ball = 0;
  const RigCamera* camera = nullptr;                   ///< nothing: a space point
  int camera_index = -1;                               ///< of the rig; −1: a space point
  int rows = 3;                                        ///< scalar observations: 2 or 3
  Eigen::Vector3d observed = Eigen::Vector3d::Zero();  ///< [px, px, 0] or [mm]
  Eigen::Matrix3d whitener = Eigen::Matrix3d::Zero();  ///< L⁻¹ of the covariance L Lᵀ
};

/// Holds a whitened residual, predicted − observed.
struct PointResidual {
  Eigen::Vector3d whitened = Eigen::Vector3d::Zero();
  Eigen::Matrix3d d_point = Eigen::Matrix3d::Zero();  ///< by the ball's world position [1/mm]
};

using PointRigJacobian = Eigen::Matrix<double, 3, RigParameter::kPerCamera>;

/// Prepares the observations of a frame, image points first.
/// Throws std::invalid_argument: a ball or camera that does not exist, a covariance that is not
/// positive definite, a number that is not finite.
std::vector<PointObservation> ObservationsOf(const MotionData& data, const MotionFrame& frame);

/// Compares an observation with the ball at `p_in_world_mm`; nothing where the camera cannot see
/// it.
std::optional<PointResidual> Compare(const PointObservation& observation,
                                     const Eigen::Vector3d& p_in_world_mm);

/// Derives the whitened residual by the parameters of its camera; zero for a space point.
PointRigJacobian CompareRigJacobian(const PointObservation& observation,
                                    const Eigen::Vector3d& p_in_world_mm);

}  // namespace stereomotion
