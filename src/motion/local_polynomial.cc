#include "motion/local_polynomial.h"

#include <Eigen/Cholesky>

#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

/// Rotation vectors turn back at π; well below it they are smooth functions of the rotation.
constexpr double kFarthest_rad = 2.7;
constexpr int kMoments = 2 * kHighestDegree + kBiasOrders + 1;

/// Residual of one observation.
Vector6d ResidualOf(const LocalPolynomial& fit, const WindowMoments::Observation& seen) {
  Vector6d residual = seen.y;
  double power = 1;
  for (int k = 0; k <= fit.degree; ++k, power *= seen.s) {
    residual -= power * fit.coefficients.segment<6>(6 * k);
  }
  return residual;
}

/// Solves once more, for the residuals: normal equations of high degree lose ten digits.
void Refine(const WindowMoments& window, LocalPolynomial& fit) {
  Eigen::VectorXd right = Eigen::VectorXd::Zero(fit.coefficients.size());
  for (const WindowMoments::Observation& seen : window.observations) {
    const Vector6d weighted = seen.information * ResidualOf(fit, seen);
    double power = 1;
    for (int k = 0; k <= fit.degree; ++k, power *= seen.s) {
      right.segment<6>(6 * k) += power * weighted;
    }
  }
  fit.coefficients += fit.covariance * right;
}

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
  observations.push_back({s, y, information});
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
  if (degree > 2) Refine(window, fit);
  fit.dof = 6 * window.poses - n;
  const Eigen::MatrixXd gains = fit.covariance * beyond;
  for (int k = 0; k < kBiasOrders; ++k) fit.bias_gains.emplace_back(gains.middleCols<6>(6 * k));
  return fit;
}

double Chi2Of(const LocalPolynomial& fit, const WindowMoments& window) {
  double chi2 = 0;
  for (const WindowMoments::Observation& seen : window.observations) {
    const Vector6d residual = ResidualOf(fit, seen);
    chi2 += residual.dot(seen.information * residual);
  }
  return chi2;
}

}  // namespace stereomotion
