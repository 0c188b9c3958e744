#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "stereomotion/motion/motion_data.h"

namespace stereomotion {

/// Holds a body that turns about one line and shifts along it:
/// pose_t = (x → Exp(φ_t a)(x − p) + p + h φ_t a) · start.
struct ScrewModel {
  Eigen::Vector3d direction;  ///< a
  Eigen::Vector3d point_mm;   ///< p
  double pitch_mm_per_rad = 0;
  Rigid3 start;
  std::vector<double> angles_rad;  ///< of the measured poses
  bool without_pitch = false;      ///< the pitch is 0, and known: its derivatives vanish
};

/// Unknowns of all poses: axis (2, across a), point (2, across a), pitch, start's rotation (2,
/// across a: the third is in the angles) and translation (3); then, only to be tested, a drift of
/// the axis across itself: uniform (2), accelerated (2).
constexpr int kScrewUnknowns = 10, kScrewAndDrift = 14;

using ScrewJacobian = Eigen::Matrix<double, 6, kScrewAndDrift>;

/// Holds the measured poses without the gaps.
struct ScrewPoses {
  std::vector<Rigid3> world_from_body;
  std::vector<Matrix6d> information;
  std::vector<std::optional<Eigen::Vector3d>> free_axes;
  std::vector<double> course;  ///< time, −1 … 1
};

ScrewPoses MeasuredPoses(const PoseSeries& series);

/// Derivative of the model's pose by its angle.
Vector6d ByAngle(const ScrewModel& model, double angle);

/// Derivative of the model's pose by all unknowns but the angles.
ScrewJacobian ByUnknowns(const ScrewModel& model, double angle, double course);

/// The same without what a change of the pose's angle would explain.
ScrewJacobian WithoutAngle(const ScrewModel& model, const ScrewPoses& poses, std::size_t i,
                           double angle);

/// Measured pose minus the model's; a rod is first rolled to the model.
Vector6d Residual(const ScrewModel& model, const ScrewPoses& poses, std::size_t i);

}  // namespace stereomotion
