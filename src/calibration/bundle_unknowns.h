#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "stereomotion/calibration/adjust_bundle.h"

namespace stereomotion {

/// Numbers the unknowns of a bundle adjustment. Global ones stand in the dense reduced system:
/// intrinsics, camera poses, and points where views are eliminated. Local ones come in blocks of up
/// to six that no observation connects: views, or points where all views are fixed.
struct BundleUnknowns {
  int num_global = 0;
  int num_intrinsics = 0;
  std::vector<int> camera_pose;  ///< first of six global unknowns, −1: fixed
  /// First global unknown of a point (its axes with σ > 0 in order), −1: local or fixed.
  std::vector<int> point_global;
  std::vector<int> point_block;  ///< local block of a point, −1: global or fixed
  std::vector<int> view_block;   ///< local block of a view, −1: fixed
  std::vector<int> block_size;
};

BundleUnknowns NumberUnknowns(const BundleProblem& problem);

/// Counts the coordinates of a point that are estimated.
int FreeAxes(const BundlePoint& point);

/// Counts the estimated parameters of a view's pose.
int PoseSize(PoseFreedom freedom);

/// Gives the directions in which a view's pose is moved: 6 × 3, 5 or 6 columns, (δθ, δt).
Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 6> PoseBasis(const BundleView& view);

/// Moves cameras, views and points by a step of all unknowns.
void ApplyStep(const BundleUnknowns& unknowns, const Eigen::VectorXd& global,
               const std::vector<Eigen::VectorXd>& local, BundleProblem& problem);

/// The estimated parameters of the cameras as a rig's covariance names them, and for each the
/// global unknown that it is.
struct RigUnknowns {
  std::vector<RigParameter> parameters;
  std::vector<int> unknown;
};
RigUnknowns ListRigUnknowns(const BundleProblem& problem, const BundleUnknowns& unknowns);

}  // namespace stereomotion
