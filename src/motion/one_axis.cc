#include "stereomotion/motion/one_axis.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "motion/axis_fit.h"
#include "motion/significance.h"
#include "stereomotion/geometry/covariance.h"
#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

using Rotations = std::vector<NoisyRotation>;

/// Beyond this standard uncertainty [rad] a direction's error is no longer linear in the noise.
constexpr double kLargestUncertainty_rad = 0.3;
/// Of Gauss–Newton's information, what must be left when the noise in the Jacobian is taken off.
constexpr double kLeastShare = 0.1;

/// χ² of the hypothesis that the body does not turn at all; nothing where a rod may hide it.
double ChiSquareAtRest(const Rotations& rotations) {
  constexpr int kIterations = 3;  // enough where the hypothesis is near; else χ² is large anyway
  Eigen::Matrix3d mean = rotations[rotations.size() / 2].rotation;
  double chi2 = 0;
  for (int i = 0; i < kIterations; ++i) {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    Eigen::Vector3d weighted = Eigen::Vector3d::Zero();
    chi2 = 0;
    for (const NoisyRotation& r : rotations) {
      const Eigen::Vector3d turn =
          LogSO3(Eigen::Quaterniond(Eigen::Matrix3d(r.rotation * mean.transpose())));
      const Eigen::Matrix3d information = r.covariance_rad2.inverse();
      sum += information;
      weighted += information * turn;
      chi2 += turn.dot(information * turn);
    }
    const Eigen::Vector3d shift = sum.inverse() * weighted;
    chi2 -= shift.dot(weighted);
    mean = ExpSO3(shift).toRotationMatrix() * mean;
  }
  return chi2;
}

/// The rotation's χ² about its own best direction would be the square of the largest singular value
/// of an N×3 matrix of noise: below (√N + √3 + z)² but for exp(−z²/2) (Davidson & Szarek 2001).
bool Rises(const Rotations& rotations, const AxisPair& pair) {
  for (const NoisyRotation& r : rotations) {
    if (r.free_axis) return true;  // judged by the uncertainty alone
  }
  constexpr double kZ = 3.72;  // exp(−z²/2) = 1e-3
  const auto n = static_cast<double>(rotations.size());
  const double scale = std::clamp(pair.chi2 / std::max(1.0, 2 * n - 4), 1.0, kVarianceSlack);
  const double limit = std::sqrt(n) + std::sqrt(3.0) + kZ;
  return ChiSquareAtRest(rotations) - pair.chi2 > scale * limit * limit;
}

/// Covariance of the four angles: Gauss–Newton's Hessian is the variance of χ²'s gradient, the
/// expected Hessian what turns it into an error. Nothing where noise makes most of the rotation.
std::optional<Eigen::Matrix4d> CovarianceOf(const AxisPair& pair) {
  const Eigen::Matrix4d inverse = PseudoInverse(pair.hessian);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(pair.gauss_newton);
  const Eigen::Vector4d scale = solver.eigenvalues().unaryExpr(
      [&](double v) { return v > 1e-12 * solver.eigenvalues()[3] ? 1 / std::sqrt(v) : 0; });
  const Eigen::Matrix4d whiten = solver.eigenvectors() * scale.asDiagonal();
  for (int k = 0; k < 4; ++k) {
    const Eigen::Vector4d direction = whiten.col(k);
    if (scale[k] > 0 && direction.dot(pair.hessian * direction) < kLeastShare) return std::nullopt;
  }
  return inverse * pair.gauss_newton * inverse;
}

/// Covariance of a unit vector of which two angles across it have `covariance`.
Eigen::Matrix3d OfUnitVector(const Eigen::Vector3d& a, const Eigen::Matrix2d& covariance) {
  const Eigen::Matrix<double, 3, 2> turned = -Hat(a) * AcrossBasis(a);
  return turned * covariance * turned.transpose();
}

/// Direction in which rods leave the body's axis open: its turn about the rod.
std::optional<Eigen::Vector3d> OpenInBody(const Rotations& rotations, const AxisPair& pair) {
  for (const NoisyRotation& r : rotations) {
    if (!r.free_axis) return std::nullopt;
  }
  const Eigen::Vector3d rod = pair.fitted.front().transpose() * *rotations.front().free_axis;
  const Eigen::Vector3d open = rod.cross(pair.in_body);
  return open.norm() > 0 ? std::optional<Eigen::Vector3d>(open.normalized()) : std::nullopt;
}

OneAxis Assemble(const Rotations& rotations, const AxisPair& pair, const Eigen::Matrix4d& cov) {
  OneAxis axis;
  std::vector<double> angles = UnwrappedAngles(rotations, pair);
  const double sense = angles.back() < 0 ? -1 : 1;
  axis.in_body = sense * pair.in_body;
  axis.in_world = sense * pair.in_world;
  axis.covariance_in_body = OfUnitVector(pair.in_body, cov.topLeftCorner<2, 2>());
  axis.covariance_in_world = OfUnitVector(pair.in_world, cov.bottomRightCorner<2, 2>());
  axis.open_in_body = OpenInBody(rotations, pair);
  axis.chi2 = pair.chi2;
  for (const NoisyRotation& r : rotations) axis.dof += r.free_axis ? 1 : 2;
  axis.dof -= axis.open_in_body ? 3 : 4;
  axis.accepted = IsAdequate(axis.chi2, axis.dof);
  axis.dispersion_rad = std::sqrt(pair.squared_angles_rad2 / static_cast<double>(rotations.size()));
  axis.total_rad = sense * angles.back();
  const auto [least, most] = std::minmax_element(angles.begin(), angles.end());
  axis.range_rad = *most - *least;
  return axis;
}

}  // namespace

Expected<OneAxis, AxisFailure> FitOneAxis(const PoseSeries& series) {
  const Rotations rotations = MeasuredRotations(series);
  if (rotations.size() < 2) return Unexpected{AxisFailure::kTooFewPoses};
  std::optional<AxisPair> pair;
  for (const AxisPair& start : StartAxes(rotations)) {
    AxisPair refined = RefineAxis(rotations, start.in_body, start.in_world);
    if (!pair || refined.chi2 < pair->chi2) pair = std::move(refined);
  }
  const std::optional<Eigen::Matrix4d> covariance = CovarianceOf(*pair);
  if (!covariance || !Rises(rotations, *pair)) return Unexpected{AxisFailure::kNoRotation};
  const OneAxis axis = Assemble(rotations, *pair, *covariance);
  if (LargestSigma(axis.covariance_in_world) > kLargestUncertainty_rad) {
    return Unexpected{AxisFailure::kNoRotation};
  }
  return axis;
}

}  // namespace stereomotion
