#include <Eigen/Cholesky>
#include <cmath>
#include <stdexcept>
#include <string>

#include "motion/axis_fit.h"

namespace stereomotion {
namespace {

void CheckCovariance(const PoseSample& pose, const Eigen::Matrix3d& covariance) {
  Eigen::Matrix3d full = covariance;
  const Eigen::Vector3d f = pose.free_axis_in_world.value_or(Eigen::Vector3d::Zero());
  full += covariance.trace() * f * f.transpose();
  if (Eigen::LLT<Eigen::Matrix3d>(full).info() != Eigen::Success) {
    throw std::invalid_argument("frame " + std::to_string(pose.frame) +
                                ": the rotation's covariance is not positive definite");
  }
}

}  // namespace

std::vector<NoisyRotation> MeasuredRotations(const PoseSeries& series) {
  std::vector<NoisyRotation> rotations;
  for (std::size_t i = 0; i < series.size(); ++i) {
    const PoseSample& pose = series[i];
    if (!pose.measured) continue;
    const Eigen::Matrix3d covariance = pose.covariance.topLeftCorner<3, 3>();
    CheckCovariance(pose, covariance);
    rotations.push_back({pose.world_from_body.rotation.toRotationMatrix(), covariance,
                         pose.free_axis_in_world, SecondsAfterFirst(series, i)});
  }
  return rotations;
}

std::vector<double> UnwrappedAngles(const std::vector<NoisyRotation>& rotations,
                                    const AxisPair& pair) {
  std::vector<double> angles = {0};
  double rate_rad_s = 0;
  for (std::size_t i = 1; i < rotations.size(); ++i) {
    const Eigen::Quaterniond step(Eigen::Matrix3d(pair.fitted[i] * pair.fitted[i - 1].transpose()));
    const double angle = 2 * std::atan2(step.vec().dot(pair.in_world), step.w());
    const double seconds = rotations[i].time_s - rotations[i - 1].time_s;
    const double foretold = rate_rad_s * seconds;
    const double taken = foretold + std::remainder(angle - foretold, 2 * M_PI);
    if (seconds > 0) rate_rad_s = taken / seconds;
    angles.push_back(angles.back() + taken);
  }
  return angles;
}

}  // namespace stereomotion
