#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "stereomotion/motion/spin_center.h"
#include "tests/support/motion_scene.h"

namespace stereomotion::testing {

using Matrix9d = Eigen::Matrix<double, 9, 9>;

/// Holds the smallest covariances that any unbiased estimate can have (Cramér–Rao).
struct MotionBound {
  Eigen::Matrix3d center_mm2;    ///< of the spin centre in the body
  std::vector<Matrix9d> states;  ///< of position, velocity, acceleration, one a frame
};

/// Computes the bound of a scene under a law: the Fisher information of all centres about every
/// frame's rotation, the spin centre and the path's coefficients, from the true Jacobians. Where
/// the motion has one axis the centre is held on the plane across it (there the information is
/// singular), the path with it.
MotionBound BoundOf(const MotionScene& scene, PathLaw law);

/// Finds the spin centre that an estimate should find: the plan's, or with one axis the point of
/// that axis nearest the balls' centroid.
Eigen::Vector3d IdentifiableCenter(const MotionScene& scene);

/// Finds the true state of a body point that moves by the plan's law (on the axis, if there is
/// one).
Eigen::Matrix<double, 9, 1> TrueStateOf(const MotionTruth& truth,
                                        const Eigen::Vector3d& p_in_body_mm);

/// Makes two unit columns across an axis.
Eigen::Matrix<double, 3, 2> Across(const Eigen::Vector3d& axis);

}  // namespace stereomotion::testing
