#pragma once

#include <Eigen/Core>

#include "stereomotion/core/expected.h"
#include "stereomotion/motion/motion_data.h"

namespace stereomotion {

/// Says why no axis was found.
enum class AxisFailure {
  kTooFewPoses,  ///< fewer than two
  kNoRotation,   ///< the rotation does not rise above its noise
};

/// Holds the axis that a body turns about, if it is one and the same in the body and in the world:
/// R_t · in_body = in_world for all t.
struct OneAxis {
  Eigen::Vector3d in_body;              ///< unit
  Eigen::Vector3d in_world;             ///< unit; the sense in which the body turned on the whole
  Eigen::Matrix3d covariance_in_body;   ///< rank 2, ⟂ in_body [rad²]
  Eigen::Matrix3d covariance_in_world;  ///< rank 2, ⟂ in_world [rad²]
  /// Of the poses' deviation from turning about one axis, in their covariances. Where it is small
  /// for its degrees of freedom nothing tells that the body turned about more than one axis.
  double chi2 = 0;
  int dof = 0;
  bool accepted = false;      ///< the data does not contradict one axis
  double dispersion_rad = 0;  ///< RMS angle between R_t · in_body and in_world
  double total_rad = 0;  ///< rotation about it from the first pose to the last, signed, unwrapped
  double range_rad = 0;  ///< largest minus smallest angle about it
};

/// Fits one axis to the rotations of a series: maximum likelihood in the poses' covariances with
/// one free angle a pose. Also where the body turned about several axes: then the axis is the best
/// single one and `dispersion_rad` tells how little that says.
Expected<OneAxis, AxisFailure> FitOneAxis(const PoseSeries& series);

}  // namespace stereomotion
