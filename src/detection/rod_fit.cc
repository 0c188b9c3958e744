#include "rod_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "normal_distribution.h"
#include "rod_fit_equations.h"
#include "rod_fit_usual.h"

namespace stereomotion {
namespace {

using State = RodFitState;
constexpr int kBall = State::kBall;
constexpr int kAll = State::kAll;
using Vector = RodFitEquations::Vector;
using Matrix = RodFitEquations::Matrix;
using Normal = RodFitEquations;

/// χ² that a further step could still win (fit_ball.cc).
constexpr double kConverged = 1e-3;
constexpr double kTrustedDamping = 1e-2;
/// A step that promised so little χ² and won none: the sharp bend where the rod's end passes behind
/// the limb. The optimum lies within 0.3 σ then.
constexpr double kStuck = 0.1;
/// χ² is summed in single precision.
constexpr double kRounding = 1e-4;

/// Longest steps of the rod's parameters: rad, px, px, DN, 1, px, 1/px.
constexpr std::array<double, RodModel::kNumParameters> kLongestStep = {0.15, 0.5, 0.5, 1e9,
                                                                       0.3,  0.5, 0.1};
constexpr double kThinnestRod_px = 0.2;  // half-width; thinner ones are told by contrast alone
constexpr double kThickestRod_radii = 0.7;
constexpr double kSteepestLean = 2;  // pointed by glue
constexpr double kDeepestSetback_radii = 0.8;

double UsualCost(const State& state, const UsualBall* usual) {
  return CompareWithUsual(state, usual).residuals.squaredNorm();
}

Normal Guided(Normal normal, const State& state, const UsualBall* usual_ball) {
  const UsualConditions usual = CompareWithUsual(state, usual_ball);
  normal.hessian.noalias() += usual.jacobian.transpose() * usual.jacobian;
  normal.gradient.noalias() -= usual.jacobian.transpose() * usual.residuals;
  return normal;
}

/// Solves (H + λ diag H) x = b in units in which diag H is 1; false: H is singular.
template <class M>
bool Solve(const Matrix& hessian, double damping, const M& rhs, M& solution) {
  const Vector scale = hessian.diagonal().cwiseMax(1e-30).cwiseSqrt().cwiseInverse();
  Matrix scaled = scale.asDiagonal() * hessian * scale.asDiagonal();
  scaled.diagonal().array() += damping;
  const Eigen::LLT<Matrix> llt(scaled);
  if (llt.info() != Eigen::Success) return false;
  solution = scale.asDiagonal() * rhs;
  llt.solveInPlace(solution);
  solution = (scale.asDiagonal() * solution).eval();
  return solution.allFinite();
}

State Step(const State& from, Vector step) {
  using P = BallModel;
  double reach = step.head<3>().cwiseAbs().maxCoeff() / (0.3 * from.ball.values[P::kRadius]);
  for (int k = 0; k < RodModel::kNumParameters; ++k) {
    reach = std::max(reach, std::abs(step[kBall + k]) / kLongestStep[static_cast<std::size_t>(k)]);
  }
  if (reach > 1) step /= reach;
  State to = from;
  auto& ball = to.ball.values;
  auto& rod = to.rod.values;
  ball.head<kBall>() += step.head<kBall>();
  rod += step.tail<RodModel::kNumParameters>();
  ball[P::kRadius] = std::max(ball[P::kRadius], 0.4);
  ball[P::kBlur] = std::clamp(ball[P::kBlur], 0.3, std::max(1.0, 0.8 * ball[P::kRadius]));
  ball[P::kShading] = std::clamp(ball[P::kShading], -0.5, 0.95);
  for (const int k : {P::kStretch1, P::kStretch2}) ball[k] = std::clamp(ball[k], -0.3, 0.3);
  rod[RodModel::kHalfWidth] =
      std::clamp(rod[RodModel::kHalfWidth], kThinnestRod_px,
                 std::max(kThickestRod_radii * ball[P::kRadius], kThinnestRod_px));
  rod[RodModel::kLean] = std::clamp(rod[RodModel::kLean], -kSteepestLean, kSteepestLean);
  rod[RodModel::kSetback] =
      std::clamp(rod[RodModel::kSetback], -1.0, kDeepestSetback_radii * ball[P::kRadius]);
  return to;
}

void Evaluate(const State& state, BallPatch& patch, RodPatch& rod_patch) {
  EvaluateBallModel(state.ball, patch);
  AddRod(state.ball, state.rod, patch, rod_patch);
}

void Finish(const BallPatch& patch, const Normal& normal, const State& state,
            const UsualBall* usual, RodFit& fit) {
  fit.ball.model = state.ball;
  fit.rod = state.rod;
  fit.ball.dof = static_cast<int>((patch.weight.head(patch.size) > 0.0F).count()) -
                 (fit.has_rod() ? kAll : kBall);
  const double area =
      kPi * state.ball.values[BallModel::kRadius] * state.ball.values[BallModel::kRadius];
  fit.ball.visible_fraction = 1 - HiddenArea(state.ball, state.rod) / area;
  Matrix covariance;
  const Matrix one = Matrix::Identity();
  Matrix hessian = normal.hessian;
  if (usual != nullptr && usual->counts) {
    const auto shape =
        CompareWithUsual(state, usual)
            .jacobian.middleRows<UsualConditions::kShape>(UsualConditions::kFirstShape);
    hessian += shape.transpose() * shape;
  }
  const bool solved = Solve(hessian, 0, one, covariance);
  fit.ball.converged = fit.ball.converged && solved && fit.ball.dof > 0;
  if (fit.ball.converged)
    fit.ball.covariance.topLeftCorner<kBall, kBall>() = covariance.topLeftCorner<kBall, kBall>();
}

}  // namespace

RodFit FitBallWithRod(const SensorNoise& noise, const BallModel& initial_ball,
                      const RodModel& initial_rod, BallPatch& patch, RodPatch& rod_patch,
                      const UsualBall* usual, int max_iterations) {
  RodFit fit;
  State state{initial_ball, initial_rod};
  Evaluate(state, patch, rod_patch);
  WeighPatch(noise, patch);
  double damping = 1e-3;
  Normal normal = MakeRodFitEquations(patch, rod_patch);
  double chi2 = PatchChi2(patch);
  while (fit.ball.iterations < max_iterations && !fit.ball.converged) {
    ++fit.ball.iterations;
    const Normal guided = Guided(normal, state, usual);
    Vector step;
    if (!Solve(guided.hessian, damping, guided.gradient, step)) {
      damping = std::max(10 * damping, 1e-6);
      continue;
    }
    const double gain = step.dot(guided.gradient);
    fit.ball.converged = damping <= kTrustedDamping && gain < kConverged;
    if (fit.ball.converged) break;
    const double cost_before = chi2 + UsualCost(state, usual);
    const State next = Step(state, step);
    Evaluate(next, patch, rod_patch);
    if (PatchChi2(patch) + UsualCost(next, usual) > cost_before && gain > kRounding * cost_before) {
      damping = std::max(10 * damping, 1e-4);
      fit.ball.converged = gain < kStuck;
      continue;
    }
    state = next;
    damping *= 0.1;
    WeighPatch(noise, patch);
    normal = MakeRodFitEquations(patch, rod_patch);
    chi2 = PatchChi2(patch);
  }
  fit.ball.chi2 = chi2;
  Finish(patch, normal, state, usual, fit);
  return fit;
}

}  // namespace stereomotion
