#include "camera_motion.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>

#include "rig_prior.h"
#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

constexpr double kChi2Of6At999 = 22.458;
constexpr double kSingular = 1e-12;  // of a correlation matrix: a direction that nothing disturbs

Rigid3 FirstFromSecond(const Rig& rig) {
  return rig.cameras[0].cam_from_world * rig.cameras[1].cam_from_world.Inverse();
}

// ∂ first_from_second / ∂ the parameters of a covariance; intrinsics do not move it. With left
// perturbations (a, b) of the first and (c, d) of the second camera, R the rotation from the second
// to the first: δθ = a − R c, δt = b − δθ × (R t₂) − R d.
Eigen::MatrixXd RelativeJacobian(const Rig& rig, const RigCovariance& covariance) {
  const Eigen::Matrix3d rotation = FirstFromSecond(rig).rotation.toRotationMatrix();
  const Eigen::Matrix3d lever = Hat(rotation * rig.cameras[1].cam_from_world.translation_mm);
  Eigen::Matrix<double, 6, 12> poses = Eigen::Matrix<double, 6, 12>::Zero();
  poses.topLeftCorner<3, 3>().setIdentity();
  poses.block<3, 3>(0, 6) = -rotation;
  poses.bottomRows<3>() = lever * poses.topRows<3>();
  poses.block<3, 3>(3, 3).setIdentity();
  poses.block<3, 3>(3, 9) = -rotation;
  Eigen::MatrixXd jacobian =
      Eigen::MatrixXd::Zero(6, static_cast<Eigen::Index>(covariance.parameters.size()));
  for (std::size_t i = 0; i < covariance.parameters.size(); ++i) {
    const auto [camera, index] = covariance.parameters[i];
    const int of_pose = index - CameraModel::kNumParameters;
    if (of_pose < 0 || camera > 1) continue;
    jacobian.col(static_cast<Eigen::Index>(i)) = poses.col(6 * camera + of_pose);
  }
  return jacobian;
}

// Covariance of the refined rig's errors with the old one's, through the prior that both hold.
Eigen::MatrixXd SharedCovariance(const RigCovariance& old, const RigCovariance& refined,
                                 const BundlePrior& prior) {
  const auto size = static_cast<Eigen::Index>(prior.covariance.parameters.size());
  Eigen::MatrixXd of_refined(refined.matrix.rows(), size), of_old(size, old.matrix.cols());
  for (Eigen::Index i = 0; i < size; ++i) {
    const RigParameter& parameter = prior.covariance.parameters[i];
    of_refined.col(i) = refined.matrix.col(PlaceOf(refined, parameter));
    const int row = PlaceOf(old, parameter);
    if (row < 0) {
      of_old.row(i).setZero();
    } else {
      of_old.row(i) = old.matrix.row(row);
    }
  }
  return of_refined * prior.covariance.matrix.llt().solve(of_old);
}

double Chi2(const Vector6d& value, const Matrix6d& covariance) {
  const Vector6d sigma = covariance.diagonal().cwiseSqrt();
  if (!(sigma.minCoeff() > 0)) return 0;
  const Vector6d inverse = sigma.cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(inverse.asDiagonal() * covariance *
                                                       inverse.asDiagonal());
  const Vector6d parts = solver.eigenvectors().transpose() * inverse.asDiagonal() * value;
  double chi2 = 0;
  for (int i = 0; i < 6; ++i) {
    if (solver.eigenvalues()[i] > kSingular) chi2 += parts[i] * parts[i] / solver.eigenvalues()[i];
  }
  return chi2;
}

}  // namespace

Matrix6d RelativeCovariance(const Rig& rig) {
  if (!rig.covariance) return Matrix6d::Zero();
  const Eigen::MatrixXd jacobian = RelativeJacobian(rig, *rig.covariance);
  return jacobian * rig.covariance->matrix * jacobian.transpose();
}

CameraMotion CompareRigs(const Rig& old_rig, const Rig& refined,
                         const std::optional<BundlePrior>& prior) {
  CameraMotion motion;
  const Rigid3 before = FirstFromSecond(old_rig), after = FirstFromSecond(refined);
  motion.change = PerturbationBetween(before, after);
  const Matrix6d own = RelativeCovariance(refined);
  motion.covariance = own + RelativeCovariance(old_rig);
  if (prior) {
    const Matrix6d shared = RelativeJacobian(refined, *refined.covariance) *
                            SharedCovariance(*old_rig.covariance, *refined.covariance, *prior) *
                            RelativeJacobian(old_rig, *old_rig.covariance).transpose();
    motion.covariance -= shared + shared.transpose();
  }
  motion.baseline_before_mm = before.translation_mm.norm();
  motion.baseline_after_mm = after.translation_mm.norm();
  const Eigen::Vector3d along = after.translation_mm.normalized();
  motion.baseline_sigma_mm = std::sqrt(along.dot(own.bottomRightCorner<3, 3>() * along));
  motion.chi2 = Chi2(motion.change, motion.covariance);
  motion.significant = motion.chi2 > kChi2Of6At999;
  return motion;
}

}  // namespace stereomotion
