#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <cmath>

#include "motion/axis_fit.h"

namespace stereomotion {
namespace {

/// Mean of the rotations: its first singular pair minimises Σ‖R_t a − b‖² over unit vectors, which
/// is SARA's criterion (Ehrig 2007) with one body at rest.
std::vector<AxisPair> StartOfFullRotations(const std::vector<NoisyRotation>& rotations) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const NoisyRotation& r : rotations) {
    if (!r.free_axis) sum += r.rotation;
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return {RefineAxis(rotations, svd.matrixV().col(0), svd.matrixU().col(0))};
}

/// Builds the body axis that makes the angle of the rods' mean with `in_world`.
Eigen::Vector3d BodyAxis(const NoisyRotation& r, const Eigen::Vector3d& mean,
                         const Eigen::Vector3d& in_world) {
  const Eigen::Vector3d rod = r.rotation.transpose() * *r.free_axis;
  const double cosine = mean.dot(in_world);
  return cosine * rod + std::sqrt(std::max(0.0, 1 - cosine * cosine)) * rod.unitOrthogonal();
}

/// A rod turns on a cone: its direction runs on a circle, whose plane's normal is the axis. Where
/// the arc is short the circle may be taken for one of the sphere's great ones: both are tried.
std::vector<AxisPair> StartOfRods(const std::vector<NoisyRotation>& rotations) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d about_zero = Eigen::Matrix3d::Zero();
  for (const NoisyRotation& r : rotations) {
    mean += *r.free_axis / static_cast<double>(rotations.size());
    about_zero += *r.free_axis * r.free_axis->transpose() / static_cast<double>(rotations.size());
  }
  std::vector<AxisPair> starts;
  for (const Eigen::Matrix3d& scatter :
       {Eigen::Matrix3d(about_zero - mean * mean.transpose()), about_zero}) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter);
    const Eigen::Vector3d in_world = solver.eigenvectors().col(0);
    starts.push_back(RefineAxis(rotations, BodyAxis(rotations.front(), mean, in_world), in_world));
  }
  return starts;
}

}  // namespace

std::vector<AxisPair> StartAxes(const std::vector<NoisyRotation>& rotations) {
  std::size_t full = 0;
  for (const NoisyRotation& r : rotations) full += r.free_axis ? 0 : 1;
  if (full > 1) return StartOfFullRotations(rotations);
  std::vector<NoisyRotation> rods;
  for (const NoisyRotation& r : rotations) {
    if (r.free_axis) rods.push_back(r);
  }
  return StartOfRods(rods);
}

}  // namespace stereomotion
