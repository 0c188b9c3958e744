#include "motion/center_covariance.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>

#include "motion/reduce_frames.h"

namespace stereomotion {
namespace {

/// Singular values of the scaled factor below this share of the largest are rounding.
constexpr double kSingular = 1e-12;
/// Below this share of signal the estimate's error is no longer linear in the noise.
constexpr double kLeastShare = 0.1;

/// Adds the difference of one frame's Schur complement between observed and Gauss–Newton Hessian,
/// in a form that cancels nothing: each term holds the curvature once.
void AddDifference(const CenterEquations& equations, const FrameCurvature& curvature,
                   Eigen::MatrixXd& difference) {
  const Eigen::MatrixXd h = equations.d_local.transpose() * equations.d_local;
  const Eigen::MatrixXd b = equations.d_local.transpose() * equations.d_global;
  const Eigen::MatrixXd h_b = h.ldlt().solve(b);
  const Eigen::MatrixXd full = h + curvature.local;
  const Eigen::PartialPivLU<Eigen::MatrixXd> lu(full);
  const Eigen::MatrixXd full_b = lu.solve(b), full_t = lu.solve(curvature.mixed);
  const Eigen::MatrixXd cross = b.transpose() * full_t;
  difference += h_b.transpose() * curvature.local * full_b - cross - cross.transpose() -
                curvature.mixed.transpose() * full_t;
}

struct Sums {
  Eigen::MatrixXd triangle, difference;
};

std::optional<Sums> Accumulate(const CenterModel& model, const CenterUnknowns& unknowns) {
  const Eigen::Index n = model.GlobalSize();
  RowStack stack(n + 1);
  Sums sums{{}, Eigen::MatrixXd::Zero(n, n)};
  for (std::size_t i = 0; i < model.frames->size(); ++i) {
    const ObservedFrame& frame = (*model.frames)[i];
    const Eigen::VectorXd local = unknowns.locals.col(static_cast<Eigen::Index>(i));
    const auto equations = Linearize(model, frame, local, unknowns.globals);
    if (!equations) return std::nullopt;
    stack.Add(EliminateLocal(*equations));
    // On a rod (one direction) the roll is open, and with it the curvature: left out.
    if (model.CenterSize() < 2) continue;
    AddDifference(*equations, CurvatureOf(model, frame, local, unknowns.globals), sums.difference);
  }
  sums.triangle = stack.Triangle();
  return sums;
}

/// U⁻¹ through the singular values of the factor with its columns scaled to unit length.
std::optional<Eigen::MatrixXd> InverseOf(const Eigen::MatrixXd& factor) {
  const Eigen::VectorXd scale = factor.colwise().norm().cwiseInverse();
  if (!scale.allFinite()) return std::nullopt;
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(factor * scale.asDiagonal(),
                                              Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Eigen::VectorXd& values = svd.singularValues();
  if (values.tail<1>()[0] < kSingular * values[0]) return std::nullopt;
  return scale.asDiagonal() * svd.matrixV() * values.cwiseInverse().asDiagonal() *
         svd.matrixU().transpose();
}

}  // namespace

std::optional<GlobalInformation> InformationOf(const CenterModel& model,
                                               const CenterUnknowns& unknowns) {
  const auto sums = Accumulate(model, unknowns);
  if (!sums) return std::nullopt;
  const Eigen::Index n = model.GlobalSize();
  const auto inverse = InverseOf(sums->triangle.topLeftCorner(n, n));
  if (!inverse) return std::nullopt;
  const Eigen::MatrixXd noise = inverse->transpose() * sums->difference * *inverse;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(0.5 * (noise + noise.transpose()));
  const Eigen::VectorXd shares = solver.eigenvalues().array() + 1;
  GlobalInformation information;
  information.least_share = shares.minCoeff();
  if (information.least_share < kLeastShare) return std::nullopt;
  const Eigen::MatrixXd directions = *inverse * solver.eigenvectors();
  information.inverse_observed =
      directions * shares.cwiseInverse().asDiagonal() * directions.transpose();
  information.covariance =
      directions * shares.cwiseAbs2().cwiseInverse().asDiagonal() * directions.transpose();
  return information;
}

}  // namespace stereomotion
