#include "pose/solve_pose.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

struct NormalEquations {
  Matrix6d hessian = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
  double chi2 = 0;
  int active = 0;
};

/// Orthonormal steps; the first one is the turn about a free axis, where there is one.
Matrix6d StepBasis(const PoseProblem& problem, const PoseState& state) {
  Matrix6d basis = Matrix6d::Identity();
  if (!problem.free_axis_in_body) return basis;
  const Eigen::Vector3d axis = state.rotation * *problem.free_axis_in_body;
  basis.block<3, 1>(0, 0) = axis;
  basis.block<3, 1>(0, 1) = axis.unitOrthogonal();
  basis.block<3, 1>(0, 2) = axis.cross(axis.unitOrthogonal());
  return basis;
}

/// Inverts the (damped) Hessian, zero along a free turn; nothing where it is singular. Its diagonal
/// is scaled to one first: radians and millimetres do not compare.
std::optional<Matrix6d> InverseHessian(const PoseProblem& problem, const PoseState& state,
                                       const Matrix6d& hessian, double damping) {
  const Matrix6d basis = StepBasis(problem, state);
  Matrix6d h = basis.transpose() * hessian * basis;
  if (problem.free_axis_in_body) {
    h.row(0).setZero();
    h.col(0).setZero();
    h(0, 0) = 1;
  }
  if (!(h.diagonal().minCoeff() > 0)) return std::nullopt;
  const Vector6d scale = h.diagonal().cwiseSqrt().cwiseInverse();
  h = (scale.asDiagonal() * h * scale.asDiagonal()).eval();
  h.diagonal().array() += damping;
  const Eigen::LLT<Matrix6d> cholesky(h);
  constexpr double kSmallestPivot = 1e-5;  // condition ≈ 1e10: beyond, digits run out
  if (cholesky.info() != Eigen::Success) return std::nullopt;
  if (cholesky.matrixLLT().diagonal().minCoeff() < kSmallestPivot) return std::nullopt;
  Matrix6d inverse = cholesky.solve(Matrix6d(scale.asDiagonal()));
  inverse = (scale.asDiagonal() * inverse).eval();
  if (problem.free_axis_in_body) {
    inverse.row(0).setZero();
    inverse.col(0).setZero();
  }
  return Matrix6d(basis * inverse * basis.transpose());
}

/// Fits all observations at `state`; one that was valid and cannot be projected makes χ² infinite.
NormalEquations Linearize(const PoseProblem& problem, const PoseState& state,
                          std::vector<ObservationFit>& fits) {
  NormalEquations equations;
  for (std::size_t i = 0; i < problem.observations.size(); ++i) {
    const PoseObservation& observation = problem.observations[i];
    const auto fit = FitObservation(problem, observation, state);
    if (fit) fits[i] = *fit;
    if (!observation.active) continue;
    if (!fit) {
      equations.chi2 = std::numeric_limits<double>::infinity();
      continue;
    }
    equations.hessian.noalias() += fit->jacobian.transpose() * fit->jacobian;
    equations.gradient.noalias() += fit->jacobian.transpose() * fit->whitened;
    equations.chi2 += fit->whitened.squaredNorm();
    ++equations.active;
  }
  return equations;
}

/// Rejects what the start cannot project: no residual of it means anything.
void RejectInvisible(PoseProblem& problem, const PoseState& state) {
  for (PoseObservation& observation : problem.observations) {
    if (!FitObservation(problem, observation, state)) observation.active = false;
  }
}

}  // namespace

PoseState Step(const PoseState& state, const Vector6d& delta) {
  return {(ExpSO3(delta.head<3>()) * state.rotation).normalized(),
          state.pivot_in_world_mm + delta.tail<3>()};
}

std::optional<PoseSolution> SolvePose(PoseProblem& problem, const PoseState& initial,
                                      int max_iterations) {
  RejectInvisible(problem, initial);
  PoseSolution solution;
  solution.state = initial;
  solution.fits.resize(problem.observations.size());
  std::vector<ObservationFit> trial_fits(problem.observations.size());
  NormalEquations now = Linearize(problem, initial, solution.fits);
  double damping = 0;
  bool converged = false;
  for (int i = 0; i < max_iterations && !converged; ++i) {
    const auto inverse = InverseHessian(problem, solution.state, now.hessian, damping);
    if (!inverse) return std::nullopt;
    const Vector6d delta = -(*inverse * now.gradient);
    // Of δᵀHδ: 1e-4 σ, and what rounding (1e-13 px) leaves of a fall in a large χ².
    const bool small = delta.dot(now.hessian * delta) < 1e-8 + 1e-12 * now.chi2;
    const PoseState trial = Step(solution.state, delta);
    const NormalEquations there = Linearize(problem, trial, trial_fits);
    if (there.chi2 <= now.chi2 || (small && std::isfinite(there.chi2))) {
      solution.state = trial;
      solution.fits.swap(trial_fits);
      now = there;
      // A damped step is short for another reason than being at the minimum.
      converged = small && damping == 0;
      damping = damping > 1e-4 ? damping / 10 : 0;
    } else {
      damping = damping > 0 ? damping * 10 : 1e-3;
    }
  }
  if (!converged) return std::nullopt;
  const auto covariance = InverseHessian(problem, solution.state, now.hessian, 0);
  if (!covariance) return std::nullopt;
  solution.covariance = *covariance;
  solution.chi2 = now.chi2;
  solution.active = now.active;
  solution.unknowns = problem.free_axis_in_body ? 5 : 6;
  return solution;
}

}  // namespace stereomotion
