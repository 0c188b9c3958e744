#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "stereomotion/core/expected.h"
#include "stereomotion/motion/motion_data.h"

namespace stereomotion {

/// Says why two bodies give no joint.
enum class JointFailure {
  kTooFewPoses,         ///< fewer than three common measured frames
  kOneRod,              ///< a body is a single rod: no frame tells its turn about itself
  kNoRelativeRotation,  ///< the bodies do not turn against each other beyond the noise
};

/// Holds the joint of two bodies: the point that rests in both, and the axis that does.
struct Joint {
  Eigen::Vector3d center_in_first_mm, center_in_second_mm;
  /// Random covariance of both centres (first, second); rank reduced by a free axis.
  Eigen::Matrix<double, 6, 6> center_covariance_mm2;
  /// Hinge: the centre is free along it, in both bodies at once. Given is the place where
  /// c₁·a₁ + c₂·a₂ = 0: midway between the points of the axis nearest the two bodies' origins.
  std::optional<Eigen::Vector3d> free_axis_in_first;
  /// The functional axis, unit: R₁ a₁ = R₂ a₂. Its sense does not depend on which body is called
  /// the first: on the mean it points along, not against, the world axis that it is nearest to.
  std::optional<Eigen::Vector3d> axis_in_first, axis_in_second;
  Eigen::Matrix3d axis_covariance_in_first, axis_covariance_in_second;
  double axis_dispersion_rad = 0;  ///< RMS angle between the two images of the axis in the world
  double range_of_rotation_rad = 0;
  double chi2 = 0;  ///< of the centres' distance over all frames
  int dof = 0;
  double rms_mm = 0;  ///< distance of the two images of the centre in the world
  std::string verdict;
};

/// Finds the joint of two bodies from their common frames; neither need rest (symmetrical: swapping
/// the bodies swaps the result). Criterion of SCoRE and SARA (Ehrig 2006, 2007), but maximum
/// likelihood in both poses' covariances with the poses as unknowns (no bias at small range).
/// The bodies' poses are taken as independent of each other. Frames are the same where their
/// numbers are; poses with a free axis (one rod) are left out. A hinge is reported where
/// `FitOneAxis` accepts one axis for the relative rotation; covariances are undamped, with the
/// second order of the rotations' noise (see one_axis.h). Where the two images of the centre differ
/// by more than the noise, the verdict says that there is no common point.
Expected<Joint, JointFailure> FindJoint(const PoseSeries& first, const PoseSeries& second);

}  // namespace stereomotion
