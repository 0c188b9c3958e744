#include "motion/screw_model.h"

#include <Eigen/LU>
#include <cmath>

#include "motion/axis_fit.h"
#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

/// Inverse covariance; zero about a free axis, whose variance is infinite.
Matrix6d InformationOf(const PoseSample& pose) {
  if (!pose.free_axis_in_world) return pose.covariance.inverse();
  Eigen::Matrix<double, 6, 5> seen = Eigen::Matrix<double, 6, 5>::Zero();
  seen.topLeftCorner<3, 2>() = AcrossBasis(*pose.free_axis_in_world);
  seen.bottomRightCorner<3, 3>().setIdentity();
  return seen * (seen.transpose() * pose.covariance * seen).inverse() * seen.transpose();
}

Eigen::Vector3d Lever(const ScrewModel& model, double angle) {
  return ExpSO3(angle * model.direction) * (model.start.translation_mm - model.point_mm);
}

Rigid3 PoseAt(const ScrewModel& model, double angle) {
  return {ExpSO3(angle * model.direction) * model.start.rotation,
          Lever(model, angle) + model.point_mm + model.pitch_mm_per_rad * angle * model.direction};
}

}  // namespace

ScrewPoses MeasuredPoses(const PoseSeries& series) {
  ScrewPoses poses;
  const double half = SecondsAfterFirst(series, series.size() - 1) / 2;
  for (std::size_t i = 0; i < series.size(); ++i) {
    if (!series[i].measured) continue;
    poses.world_from_body.push_back(series[i].world_from_body);
    poses.information.push_back(InformationOf(series[i]));
    poses.free_axes.push_back(series[i].free_axis_in_world);
    poses.course.push_back(SecondsAfterFirst(series, i) / half - 1);
  }
  return poses;
}

Vector6d ByAngle(const ScrewModel& model, double angle) {
  Vector6d by_angle;
  by_angle << model.direction,
      model.direction.cross(Lever(model, angle)) + model.pitch_mm_per_rad * model.direction;
  return by_angle;
}

ScrewJacobian ByUnknowns(const ScrewModel& model, double angle, double course) {
  const Eigen::Matrix<double, 3, 2> basis = AcrossBasis(model.direction);
  const Eigen::Matrix3d turn = ExpSO3(angle * model.direction).toRotationMatrix();
  const Eigen::Matrix<double, 3, 2> chord = basis - turn * basis;
  ScrewJacobian by = ScrewJacobian::Zero();
  by.block<3, 2>(0, 0) = chord;
  by.block<3, 2>(3, 0) = -Hat(Lever(model, angle)) * chord -
                         model.pitch_mm_per_rad * angle * Hat(model.direction) * basis;
  by.block<3, 2>(3, 2) = chord;
  if (!model.without_pitch) by.block<3, 1>(3, 4) = angle * model.direction;
  by.block<3, 2>(0, 5) = turn * basis;
  by.block<3, 3>(3, 7) = turn;
  by.block<3, 2>(3, 10) = course * basis;
  by.block<3, 2>(3, 12) = course * course * basis;
  return by;
}

ScrewJacobian WithoutAngle(const ScrewModel& model, const ScrewPoses& poses, std::size_t i,
                           double angle) {
  const ScrewJacobian by = ByUnknowns(model, angle, poses.course[i]);
  const Vector6d j = ByAngle(model, angle);
  const Vector6d weighted = poses.information[i] * j;
  return by - j * (weighted.transpose() * by) / weighted.dot(j);
}

Vector6d Residual(const ScrewModel& model, const ScrewPoses& poses, std::size_t i) {
  const Rigid3 expected = PoseAt(model, model.angles_rad[i]);
  Rigid3 measured = poses.world_from_body[i];
  if (poses.free_axes[i]) {
    const Eigen::Quaterniond off = expected.rotation * measured.rotation.conjugate();
    const double roll = 2 * std::atan2(off.vec().dot(*poses.free_axes[i]), off.w());
    measured.rotation = ExpSO3(roll * *poses.free_axes[i]) * measured.rotation;
  }
  return PerturbationBetween(expected, measured);
}

}  // namespace stereomotion
