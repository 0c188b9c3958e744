#include "motion/axis_fit.h"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

using Matrix32 = Eigen::Matrix<double, 3, 2>;

/// Of the angle between a rod and the axis, below which the rod does not turn about itself [rad].
constexpr double kParallel = 1e-6;

/// Turns a rotation with a free axis about that axis until it obeys the pair best.
Eigen::Matrix3d Rolled(const NoisyRotation& r, const Eigen::Vector3d& a_body,
                       const Eigen::Vector3d& a_world) {
  if (!r.free_axis) return r.rotation;
  const Eigen::Vector3d& f = *r.free_axis;
  const Eigen::Vector3d a = r.rotation * a_body;
  const double sine = f.dot(a.cross(a_world));
  const double cosine = a.dot(a_world) - f.dot(a) * f.dot(a_world);
  return Eigen::AngleAxisd(std::atan2(sine, cosine), f).toRotationMatrix() * r.rotation;
}

/// Finds the smallest rotation vector that leads from one unit vector to another.
Eigen::Vector3d TurnBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d cross = from.cross(to);
  const double sine = cross.norm();
  if (sine == 0) return Eigen::Vector3d::Zero();
  return std::atan2(sine, from.dot(to)) / sine * cross;
}

/// Information of the two angles across the axis; of a rod only what no roll can explain.
Eigen::Matrix2d AcrossInformation(const NoisyRotation& r, const Matrix32& across) {
  const Eigen::Matrix2d covariance = across.transpose() * r.covariance_rad2 * across;
  if (!r.free_axis) return covariance.inverse();
  const Eigen::Vector2d v = across.transpose() * *r.free_axis;
  if (v.norm() < kParallel) return covariance.inverse();
  const Eigen::Vector2d w = Eigen::Vector2d(-v.y(), v.x()).normalized();
  return w * w.transpose() / w.dot(covariance * w);
}

/// Adds one rotation to the normal equations. The angle about the axis is eliminated: its error
/// given the errors across follows from their correlation, and what remains of it is noise in the
/// Jacobian, which raises Gauss–Newton's Hessian above the true one (errors in variables). A rod's
/// own roll is not noisy but free; its part in that second-order term is left out.
void AddRotation(const NoisyRotation& r, const Matrix32& b_body, const Matrix32& b_world,
                 AxisPair& pair) {
  const Eigen::Matrix3d rotation = Rolled(r, pair.in_body, pair.in_world);
  const Eigen::Vector3d turn = TurnBetween(pair.in_world, rotation * pair.in_body);
  const Eigen::Vector2d residual = b_world.transpose() * turn;
  const Eigen::Matrix2d information = AcrossInformation(r, b_world);
  const Eigen::Vector2d coupling =
      r.free_axis ? Eigen::Vector2d::Zero()
                  : Eigen::Vector2d(b_world.transpose() * r.covariance_rad2 * pair.in_world);
  const double along = coupling.dot(information * residual);
  const double variance = r.free_axis ? 0
                                      : pair.in_world.dot(r.covariance_rad2 * pair.in_world) -
                                            coupling.dot(information * coupling);
  const Eigen::Matrix3d fitted =
      ExpSO3(-turn - along * pair.in_world).toRotationMatrix() * rotation;
  Eigen::Matrix<double, 2, 4> jacobian;
  jacobian << b_world.transpose() * fitted * b_body, -Eigen::Matrix2d::Identity();
  const Eigen::Matrix2d noise = b_world.transpose() * Hat(pair.in_world) * fitted * b_body;
  pair.gauss_newton += jacobian.transpose() * information * jacobian;
  pair.hessian.topLeftCorner<2, 2>() -= variance * noise.transpose() * information * noise;
  pair.gradient += jacobian.transpose() * information * residual;
  pair.chi2 += residual.dot(information * residual);
  pair.squared_angles_rad2 += turn.squaredNorm();
  pair.fitted.push_back(fitted);
}

Eigen::Vector3d Turned(const Eigen::Vector3d& a, const Eigen::Vector2d& step) {
  return (ExpSO3(AcrossBasis(a) * step) * a).normalized();
}

}  // namespace

Eigen::Matrix<double, 3, 2> AcrossBasis(const Eigen::Vector3d& a) {
  Matrix32 basis;
  basis.col(0) = a.unitOrthogonal();
  basis.col(1) = a.cross(basis.col(0));
  return basis;
}

Eigen::MatrixXd PseudoInverse(const Eigen::MatrixXd& symmetric) {
  constexpr double kRounding = 1e-12;  // of the largest eigenvalue; below it is rounding
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(symmetric);
  const double least = kRounding * solver.eigenvalues().cwiseAbs().maxCoeff();
  const Eigen::VectorXd inverse = solver.eigenvalues().unaryExpr(
      [least](double value) { return value > least ? 1 / value : 0; });
  return solver.eigenvectors() * inverse.asDiagonal() * solver.eigenvectors().transpose();
}

AxisPair EvaluateAxis(const std::vector<NoisyRotation>& rotations, const Eigen::Vector3d& in_body,
                      const Eigen::Vector3d& in_world) {
  AxisPair pair{in_body,
                in_world,
                0,
                Eigen::Matrix4d::Zero(),
                Eigen::Matrix4d::Zero(),
                Eigen::Vector4d::Zero(),
                {},
                0};
  const Matrix32 b_body = AcrossBasis(in_body);
  const Matrix32 b_world = AcrossBasis(in_world);
  pair.fitted.reserve(rotations.size());
  for (const NoisyRotation& r : rotations) AddRotation(r, b_body, b_world, pair);
  pair.hessian += pair.gauss_newton;
  return pair;
}

AxisPair RefineAxis(const std::vector<NoisyRotation>& rotations, const Eigen::Vector3d& in_body,
                    const Eigen::Vector3d& in_world) {
  constexpr int kMaxIterations = 100, kMaxHalvings = 12;
  constexpr double kDone = 1e-9, kRounding = 1e-13;  // decrease of χ², absolute and of itself
  AxisPair best = EvaluateAxis(rotations, in_body, in_world);
  for (int i = 0; i < kMaxIterations; ++i) {
    Eigen::Vector4d step = -PseudoInverse(best.gauss_newton) * best.gradient;
    if (-step.dot(best.gradient) < kDone + kRounding * best.chi2) break;
    bool better = false;
    for (int halving = 0; halving < kMaxHalvings && !better; ++halving, step /= 2) {
      AxisPair next = EvaluateAxis(rotations, Turned(best.in_body, step.head<2>()),
                                   Turned(best.in_world, step.tail<2>()));
      better = next.chi2 < best.chi2;
      if (better) best = std::move(next);
    }
    if (!better) break;
  }
  return best;
}

}  // namespace stereomotion
