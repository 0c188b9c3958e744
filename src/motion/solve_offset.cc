#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "motion/offset_problem.h"

namespace stereomotion {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

/// Lays the upper triangle of the band out as a sparse matrix.
Sparse SparseHessian(const OffsetNormals& normals) {
  const int size = static_cast<int>(normals.hessian.size());
  std::vector<Eigen::Triplet<double>> entries;
  for (int k = 0; k < size; ++k) {
    for (int d = 0; d <= OffsetNormals::kBand && k + d < size; ++d) {
      for (int a = 0; a < 6; ++a) {
        for (int b = d == 0 ? a : 0; b < 6; ++b) {
          entries.emplace_back(6 * k + a, 6 * (k + d) + b, normals.hessian[k](a, 6 * d + b));
        }
      }
    }
  }
  Sparse matrix(6 * size, 6 * size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// Moves all unknowns by one Gauss–Newton step; returns how much χ² should fall by it, or nothing
/// where the equations are singular.
std::optional<double> Step(const OffsetNormals& normals, bool fixed, OffsetUnknowns& at) {
  Eigen::MatrixXd right(normals.gradient.size(), 1 + normals.cross.cols());
  right << normals.gradient, normals.cross;
  const auto solved = SolvePoses(normals, right);
  if (!solved) return std::nullopt;
  const Eigen::Index first = fixed ? 1 : 0, count = normals.cross.cols() - first;
  const Eigen::MatrixXd cross = normals.cross.rightCols(count);
  const Eigen::MatrixXd by_shared = solved->rightCols(count);
  Eigen::VectorXd shared = Eigen::VectorXd::Zero(normals.cross.cols());
  if (count > 0) {
    const Eigen::LLT<Eigen::MatrixXd> information(
        normals.information.bottomRightCorner(count, count) - cross.transpose() * by_shared);
    if (information.info() != Eigen::Success) return std::nullopt;
    shared.tail(count) = -information.solve(normals.shared_gradient.tail(count) -
                                            cross.transpose() * solved->col(0));
  }
  const Eigen::VectorXd step = -solved->col(0) - by_shared * shared.tail(count);
  for (std::size_t k = 0; k < at.poses.size(); ++k) {
    at.poses[k] = Perturb(at.poses[k], step.segment<6>(6 * static_cast<int>(k)));
  }
  at.offset_s += shared[0];
  at.common += shared.tail(at.common.size());
  return -(step.dot(normals.gradient) + shared.dot(normals.shared_gradient));
}

}  // namespace

std::optional<Eigen::MatrixXd> SolvePoses(const OffsetNormals& normals,
                                          const Eigen::MatrixXd& right) {
  const Eigen::SimplicialLDLT<Sparse, Eigen::Upper> factor(SparseHessian(normals));
  if (factor.info() != Eigen::Success || !(factor.vectorD().minCoeff() > 0)) return std::nullopt;
  return factor.solve(right);
}

Matrix6d PoseCovariance(const OffsetNormals& normals, int k) {
  const int size = static_cast<int>(normals.hessian.size());
  const int from = std::max(k - OffsetNormals::kBand, 0);
  const int to = std::min(k + OffsetNormals::kBand, size - 1);
  Eigen::MatrixXd window = Eigen::MatrixXd::Zero(6 * (to - from + 1), 6 * (to - from + 1));
  for (int a = from; a <= to; ++a) {
    for (int b = a; b <= std::min(to, a + OffsetNormals::kBand); ++b) {
      const Matrix6d block = normals.hessian[a].block<6, 6>(0, 6 * (b - a));
      window.block<6, 6>(6 * (a - from), 6 * (b - from)) = block;
      if (b > a) window.block<6, 6>(6 * (b - from), 6 * (a - from)) = block.transpose();
    }
  }
  Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(window.rows(), 6);
  unit.middleRows<6>(6 * (k - from)).setIdentity();
  const Eigen::MatrixXd solved = window.llt().solve(unit);
  const Matrix6d covariance = solved.middleRows<6>(6 * (k - from));
  return (covariance + covariance.transpose()) / 2;
}

std::optional<Eigen::MatrixXd> SharedInformation(const OffsetNormals& normals) {
  const auto solved = SolvePoses(normals, normals.cross);
  if (!solved) return std::nullopt;
  return normals.information - normals.cross.transpose() * *solved;
}

std::optional<OffsetSolution> SolveOffset(const OffsetProblem& problem, double offset_s,
                                          bool fixed) {
  constexpr int kMaxIterations = 20;
  constexpr double kSmallFall = 1e-6;  // of χ²: a step of a thousandth of the uncertainty
  constexpr double kReachPeriods = 1.5;
  OffsetSolution solution{problem.Start(offset_s), {}};
  for (int i = 0; i < kMaxIterations; ++i) {
    auto normals = problem.Linearize(solution.at);
    if (!normals) return std::nullopt;
    solution.normals = std::move(*normals);
    const auto fall = Step(solution.normals, fixed, solution.at);
    if (!fall || std::abs(solution.at.offset_s) > kReachPeriods * problem.period_s()) {
      return std::nullopt;
    }
    if (*fall > kSmallFall * std::max(1.0, 1e-6 * solution.normals.chi2)) continue;
    auto last = problem.Linearize(solution.at);
    if (!last) return std::nullopt;
    solution.normals = std::move(*last);
    return solution;
  }
  return std::nullopt;
}

}  // namespace stereomotion
