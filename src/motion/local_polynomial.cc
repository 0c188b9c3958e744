#include "motion/local_polynomial.h"

#include <Eigen/Cholesky>

#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

/// Rotation vectors turn back at π; well below it they are smooth functions of the rotation.
constexpr double kFarthest_rad = 2.7;
constexpr int kMoments = 2 * kHighestDegree + kBiasOrders + 1;

}  // namespace

WindowMoments::WindowMoments(const PoseStretch& of, double about_s, const Rigid3& from)
    : stretch(of),
      time_s(about_s),
      reference(from),
      moments(kMoments, Matrix6d::Zero()),
      observed(kHighestDegree + 1, Vector6d::Zero()) {}

bool WindowMoments::Add(std::size_t i) {
  const Vector6d y = PerturbationBetween(reference, stretch.poses[i]);
  if (y.head<3>().norm() > kFarthest_rad) return false;
  Matrix6d to_world = Matrix6d::Identity();  // error of the pose by error of the rotation vector
  to_world.topLeftCorner<3, 3>() = LeftJacobianSO3(y.head<3>());
  const Matrix6d information = to_world.transpose() * stretch.information[i] * to_world;
  const Vector6d weighted = information * y;
  const double s = (stretch.times_s[i] - time_s) / stretch.unit_s;
  double power = 1;
  for (int p = 0; p < kMoments; ++p, power *= s) {
    moments[p] += power * information;
    if (p <= kHighestDegree) observed[p] += power * weighted;
  }
  squares += y.dot(weighted);
  ++poses;
  return true;
}

LocalPolynomial FitLocalPolynomial(const WindowMoments& window, int degree) {
  const int n = 6 * (degree + 1);
  Eigen::MatrixXd normal(n, n), beyond(n, 6 * kBiasOrders);
  Eigen::VectorXd right(n);
  for (int row = 0; row <= degree; ++row) {
    right.segment<6>(6 * row) = window.observed[row];
    for (int col = 0; col <= degree; ++col) {
      normal.block<6, 6>(6 * row, 6 * col) = window.moments[row + col];
    }
    for (int k = 0; k < kBiasOrders; ++k) {
      beyond.block<6, 6>(6 * row, 6 * k) = window.moments[row + degree + 1 + k];
    }
  }
  const Eigen::VectorXd scale = normal.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::LLT<Eigen::MatrixXd> llt(scale.asDiagonal() * normal * scale.asDiagonal());
  LocalPolynomial fit;
  fit.degree = degree;
  fit.covariance = scale.asDiagonal() * llt.solve(Eigen::MatrixXd(scale.asDiagonal()));
  fit.coefficients = fit.covariance * right;
  fit.chi2 = window.squares - fit.coefficients.dot(right);
  fit.dof = 6 * window.poses - n;
  const Eigen::MatrixXd gains = fit.covariance * beyond;
  for (int k = 0; k < kBiasOrders; ++k) fit.bias_gains.emplace_back(gains.middleCols<6>(6 * k));
  return fit;
}

}  // namespace stereomotion
