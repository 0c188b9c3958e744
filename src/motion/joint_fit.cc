#include "motion/joint_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>

#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

using Matrix3x12 = Eigen::Matrix<double, 3, 12>;
using Vector12d = Eigen::Matrix<double, 12, 1>;
using Matrix36 = Eigen::Matrix<double, 3, 6>;

/// Distance of both images of the centre, first minus second.
Eigen::Vector3d Distance(const Rigid3& first, const Rigid3& second, const Vector6d& centers) {
  return first * Eigen::Vector3d(centers.head<3>()) - second * Eigen::Vector3d(centers.tail<3>());
}

/// Derivative of the distance by the perturbations of both poses.
Matrix3x12 ByPoses(const Rigid3& first, const Rigid3& second, const Vector6d& centers) {
  Matrix3x12 by;
  by << -Hat(first.rotation * centers.head<3>()), Eigen::Matrix3d::Identity(),
      Hat(second.rotation * centers.tail<3>()), -Eigen::Matrix3d::Identity();
  return by;
}

/// Holds one frame's poses moved, as little as their covariances ask, to where the centres meet.
struct Adjusted {
  Rigid3 first, second;
  Eigen::Vector3d misclosure;  ///< of the measured poses, linear at the adjusted ones
  Eigen::Matrix3d weight;
  Matrix12d covariance;  ///< of the adjusted poses, centres given
};

Adjusted Adjust(const PosePair& pair, const Matrix12d& noise, const Vector6d& centers) {
  constexpr int kRounds = 3;  // the second round is exact to the square of the noise
  Adjusted adjusted{pair.first, pair.second, {}, {}, {}};
  Vector12d error = Vector12d::Zero();
  for (int round = 0; round < kRounds; ++round) {
    const Matrix3x12 by = ByPoses(adjusted.first, adjusted.second, centers);
    adjusted.weight = (by * noise * by.transpose()).inverse();
    adjusted.misclosure = Distance(adjusted.first, adjusted.second, centers) + by * error;
    const Eigen::Matrix<double, 12, 3> gain = noise * by.transpose() * adjusted.weight;
    error = gain * adjusted.misclosure;
    adjusted.first = Perturb(pair.first, -error.head<6>());
    adjusted.second = Perturb(pair.second, -error.tail<6>());
    adjusted.covariance = noise - gain * by * noise;
  }
  return adjusted;
}

Matrix36 ByCenters(const Adjusted& adjusted) {
  Matrix36 by;
  by << adjusted.first.rotation.toRotationMatrix(), -adjusted.second.rotation.toRotationMatrix();
  return by;
}

/// E[δJᵀ W δJ] over the noise of the adjusted rotations.
Matrix6d JacobianNoise(const Adjusted& adjusted, const Matrix36& by_centers) {
  Matrix6d turns;  // covariance of both rotations
  turns << adjusted.covariance.block<3, 3>(0, 0), adjusted.covariance.block<3, 3>(0, 6),
      adjusted.covariance.block<3, 3>(6, 0), adjusted.covariance.block<3, 3>(6, 6);
  Matrix6d noise;
  for (int a = 0; a < 6; ++a) {
    const Eigen::Matrix3d left = Hat(by_centers.col(a)).transpose() * adjusted.weight;
    for (int b = 0; b < 6; ++b) {
      const Eigen::Matrix3d between = turns.block<3, 3>(b < 3 ? 0 : 3, a < 3 ? 0 : 3);
      noise(a, b) = (left * Hat(by_centers.col(b)) * between).trace();
    }
  }
  return noise;
}

}  // namespace

JointFit EvaluateJoint(const std::vector<PosePair>& pairs, const Vector6d& centers_mm) {
  JointFit fit{centers_mm, 0, Matrix6d::Zero(), Matrix6d::Zero(), Vector6d::Zero(), 0};
  for (const PosePair& pair : pairs) {
    Matrix12d noise = Matrix12d::Zero();
    noise.topLeftCorner<6, 6>() = pair.first_covariance;
    noise.bottomRightCorner<6, 6>() = pair.second_covariance;
    const Adjusted adjusted = Adjust(pair, noise, centers_mm);
    const Matrix36 by = ByCenters(adjusted);
    fit.gauss_newton += by.transpose() * adjusted.weight * by;
    fit.hessian -= JacobianNoise(adjusted, by);
    fit.gradient += by.transpose() * adjusted.weight * adjusted.misclosure;
    fit.chi2 += adjusted.misclosure.dot(adjusted.weight * adjusted.misclosure);
    fit.squares_mm2 += Distance(pair.first, pair.second, centers_mm).squaredNorm();
  }
  fit.hessian += fit.gauss_newton;
  return fit;
}

JointFit FitJoint(const std::vector<PosePair>& pairs, const Eigen::MatrixXd& basis) {
  constexpr int kMaxIterations = 50;
  constexpr double kDone = 1e-10;  // decrease of χ² that is still to come
  const auto n = static_cast<Eigen::Index>(pairs.size());
  Eigen::MatrixXd rows(3 * n, basis.cols());
  Eigen::VectorXd right(3 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    Matrix36 by;
    by << pairs[i].first.rotation.toRotationMatrix(), -pairs[i].second.rotation.toRotationMatrix();
    rows.middleRows<3>(3 * i) = by * basis;
    right.segment<3>(3 * i) = pairs[i].second.translation_mm - pairs[i].first.translation_mm;
  }
  Vector6d centers = basis * rows.colPivHouseholderQr().solve(right);
  JointFit fit = EvaluateJoint(pairs, centers);
  for (int i = 0; i < kMaxIterations; ++i) {
    const Eigen::VectorXd gradient = basis.transpose() * fit.gradient;
    const Eigen::MatrixXd information = basis.transpose() * fit.gauss_newton * basis;
    const Eigen::VectorXd step = information.ldlt().solve(gradient);
    if (step.dot(gradient) < kDone) break;
    fit = EvaluateJoint(pairs, fit.centers_mm - basis * step);
  }
  return fit;
}

}  // namespace stereomotion
