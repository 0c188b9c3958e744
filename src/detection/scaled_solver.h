#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace stereomotion {

/// Solves (H + λ diag H) x = g in units in which diag H is 1: the parameters' scales differ by 1e6.
template <int N>
struct ScaledSolver {
  using Matrix = Eigen::Matrix<double, N, N>;
  using Vector = Eigen::Matrix<double, N, 1>;

  ScaledSolver(const Matrix& hessian, double damping)
      : scale(hessian.diagonal().cwiseMax(1e-30).cwiseSqrt().cwiseInverse()) {
    Matrix scaled = scale.asDiagonal() * hessian * scale.asDiagonal();
    scaled.diagonal().array() += damping;
    llt.compute(scaled);
  }
  [[nodiscard]] bool ok() const { return llt.info() == Eigen::Success; }
  template <class M>
  [[nodiscard]] auto Solve(const M& rhs) const {
    return (scale.asDiagonal() * llt.solve(scale.asDiagonal() * rhs)).eval();
  }
  Vector scale;
  Eigen::LLT<Matrix> llt;
};

}  // namespace stereomotion
