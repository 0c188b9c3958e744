#pragma once

#include <Eigen/Core>
#include <optional>

#include "stereomotion/core/expected.h"
#include "stereomotion/motion/motion_data.h"

namespace stereomotion {

/// Says why no axis was found.
enum class AxisFailure {
  kTooFewPoses,  ///< fewer than two
  kNoRotation,   ///< the rotation does not rise above its noise, or tells no axis to 0.3 rad
};

/// Holds the axis that a body turns about, if it is one and the same in the body and in the world:
/// R_t · in_body = in_world for all t. Covariances are of the unit vectors' components; they are
/// first order in the axes' error but hold the second order of the poses' noise (errors in
/// variables), so they stay true where the range of rotation is only a few times the noise.
struct OneAxis {
  Eigen::Vector3d in_body;              ///< unit
  Eigen::Vector3d in_world;             ///< unit; the sense in which the body turned on the whole
  Eigen::Matrix3d covariance_in_body;   ///< rank 2, ⟂ in_body [rad²]
  Eigen::Matrix3d covariance_in_world;  ///< rank 2, ⟂ in_world [rad²]
  /// Rods alone (every pose has a free axis) tell only the angle between rod and axis: unit vector
  /// along which `in_body` may turn about the rod. Its variance there is infinite (zero is
  /// written).
  std::optional<Eigen::Vector3d> open_in_body;
  /// Of the poses' deviation from turning about one axis, in their covariances; 2N − 4 degrees of
  /// freedom (N − 3 of rods alone).
  double chi2 = 0;
  int dof = 0;
  /// The data does not contradict one axis: χ² below what noise exceeds once in 1000, times 1.25.
  /// The factor is for real noise, whose σ may be stated 12 % too small; a second rotation hidden
  /// by it is below half the poses' noise (variance) and could not carry a credible statement.
  bool accepted = false;
  double dispersion_rad = 0;  ///< RMS angle between R_t · in_body and in_world
  double total_rad = 0;  ///< rotation about it from the first pose to the last, signed, unwrapped
  double range_rad = 0;  ///< largest minus smallest angle about it
};

/// Fits one axis to the rotations of a series: maximum likelihood in the poses' covariances with
/// one free angle a pose. Angles are unwrapped in time: less than half a turn between neighbours,
/// or across a gap less than half a turn off the rate before it. Throws std::invalid_argument for a
/// measured pose whose rotation has no positive definite covariance (but for its free axis). Also
/// where the body turned about several axes: then the axis is the best single one and
/// `dispersion_rad` tells how little that says.
Expected<OneAxis, AxisFailure> FitOneAxis(const PoseSeries& series);

}  // namespace stereomotion
