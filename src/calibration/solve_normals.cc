#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "bundle_normals.h"

namespace stereomotion {
namespace {

// Reciprocal condition of the unit-scaled equations below which rounding decides.
constexpr double kSingular = 1e-15;

Eigen::MatrixXd Damped(const Eigen::MatrixXd& matrix, double damping) {
  Eigen::MatrixXd damped = matrix;
  damped.diagonal() *= 1 + damping;
  return damped;
}

}  // namespace

bool SolveNormals(const BundleNormals& normals, double damping, BundleStep& step) {
  Eigen::MatrixXd reduced = Damped(normals.global, damping);
  Eigen::VectorXd rhs = normals.rhs;
  std::vector<Eigen::LLT<Eigen::MatrixXd>> factors;
  for (const auto& block : normals.blocks) {
    factors.emplace_back(Damped(block.local, damping));
    if (factors.back().info() != Eigen::Success) return false;
    const Eigen::MatrixXd half = factors.back().matrixL().solve(block.cross);
    reduced.noalias() -= half.transpose() * half;
    rhs -= block.cross.transpose() * factors.back().solve(block.rhs);
  }
  const Eigen::LDLT<Eigen::MatrixXd> solver(reduced);
  if (solver.info() != Eigen::Success || !solver.isPositive()) return false;
  step.global = solver.solve(rhs);
  step.local.resize(normals.blocks.size());
  for (std::size_t i = 0; i < normals.blocks.size(); ++i) {
    const auto& block = normals.blocks[i];
    step.local[i] = factors[i].solve(block.rhs - block.cross * step.global);
  }
  return step.global.allFinite();
}

BundleCovariance InvertNormals(const BundleNormals& normals) {
  BundleCovariance result;
  Eigen::MatrixXd reduced = normals.global;
  std::vector<Eigen::MatrixXd> inverses;
  for (const auto& block : normals.blocks) {
    const Eigen::LLT<Eigen::MatrixXd> factor(block.local);
    if (factor.info() != Eigen::Success) return result;
    inverses.push_back(
        factor.solve(Eigen::MatrixXd::Identity(block.local.rows(), block.local.cols())));
    reduced.noalias() -= block.cross.transpose() * inverses.back() * block.cross;
  }
  const Eigen::VectorXd diagonal = normals.global.diagonal();
  if (diagonal.size() > 0 && !(diagonal.minCoeff() > 0)) return result;
  const Eigen::VectorXd scale = diagonal.cwiseSqrt().cwiseInverse();
  reduced = scale.asDiagonal() * reduced * scale.asDiagonal();
  const Eigen::LLT<Eigen::MatrixXd> factor(reduced);
  if (factor.info() != Eigen::Success || factor.rcond() < kSingular) {
    result.weakest_direction =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(reduced).eigenvectors().col(0);
    return result;
  }
  result.global = scale.asDiagonal() *
                  factor.solve(Eigen::MatrixXd::Identity(reduced.rows(), reduced.cols())) *
                  scale.asDiagonal();
  for (std::size_t i = 0; i < normals.blocks.size(); ++i) {
    const Eigen::MatrixXd gain = inverses[i] * normals.blocks[i].cross;
    result.local.push_back(inverses[i] + gain * result.global * gain.transpose());
  }
  return result;
}

}  // namespace stereomotion
