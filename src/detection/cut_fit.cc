#include "cut_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "normal_distribution.h"

namespace stereomotion {
namespace {

using P = BallModel;

enum { kAngle = P::kNumParameters, kPlace, kContrast, kAll };
using Vector = Eigen::Matrix<double, kAll, 1>;
using Matrix = Eigen::Matrix<double, kAll, kAll>;

constexpr int kMaxIterations = 30;
constexpr double kConverged = 1e-3;  // χ² that a further step could still win
/// What guides the fit: spreads of stretch, of the blur against its guess, of shading.
constexpr double kStretchSpread = 0.01;
constexpr double kBlurSpread = 0.3;
constexpr double kUsualShading = 0.15;
constexpr double kShadingSpread = 0.15;
constexpr double kLongestStep_px = 0.7;

struct State {
  BallModel ball;
  CutEdge edge;
};

struct Normal {
  Matrix hessian = Matrix::Zero();
  Vector gradient = Vector::Zero();
  double chi2 = 0, cost = 0;
  int used = 0;
};

/// Adds an unknown's usual value as an observation.
void Guide(int k, double value, double usual, double spread, Normal& normal) {
  const double residual = (value - usual) / spread;
  normal.hessian(k, k) += 1 / (spread * spread);
  normal.gradient[k] -= residual / spread;
  normal.cost += residual * residual;
}

/// Writes a pixel's derivatives and returns its predicted grey value; `patch` holds the whole ball.
double Predict(const State& state, const BallPatch& patch, int i, Vector& by) {
  const auto& p = state.ball.values;
  const double cosine = std::cos(state.edge.angle_rad), sine = std::sin(state.edge.angle_rad);
  const double u = patch.u[i], v = patch.v[i];
  const double beyond = (state.edge.place_px - cosine * u - sine * v) / p[P::kBlur];
  const double free = 0.5 * std::erfc(-beyond / std::sqrt(2.0));
  const double plane = p[P::kLevel] + p[P::kSlopeU] * u + p[P::kSlopeV] * v;
  const double light = patch.model[i] - plane;
  const double density = std::exp(-0.5 * beyond * beyond) / std::sqrt(2 * kPi) / p[P::kBlur];
  const double by_place = (light - state.edge.contrast_dn) * density;
  for (int k = 0; k < P::kNumParameters; ++k) {
    by[k] = (k < P::kLevel ? free : 1) * static_cast<double>(patch.jacobian(i, k));
  }
  by[P::kBlur] -= by_place * beyond;
  by[kAngle] = by_place * (sine * u - cosine * v);
  by[kPlace] = by_place;
  by[kContrast] = 1 - free;
  return plane + free * light + (1 - free) * state.edge.contrast_dn;
}

Normal Evaluate(const SensorNoise& noise, const State& state, double usual_blur_px,
                BallPatch& patch) {
  Normal normal;
  EvaluateBallModel(state.ball, patch);
  Vector by;
  for (int i = 0; i < patch.size; ++i) {
    const double model = Predict(state, patch, i, by);
    if (patch.grey[i] >= noise.saturation_dn) continue;
    const double weight = 1 / noise.VarianceDn2(model);
    const double residual = patch.grey[i] - model;
    normal.hessian.selfadjointView<Eigen::Lower>().rankUpdate(by, weight);
    normal.gradient += weight * residual * by;
    normal.chi2 += weight * residual * residual;
    // The normal likelihood: its variance depends on the model.
    normal.cost += weight * residual * residual - std::log(weight);
    ++normal.used;
  }
  normal.hessian = normal.hessian.selfadjointView<Eigen::Lower>();
  const auto& p = state.ball.values;
  Guide(P::kStretch1, p[P::kStretch1], 0, kStretchSpread, normal);
  Guide(P::kStretch2, p[P::kStretch2], 0, kStretchSpread, normal);
  Guide(P::kBlur, p[P::kBlur], usual_blur_px, kBlurSpread * usual_blur_px, normal);
  Guide(P::kShading, p[P::kShading], kUsualShading, kShadingSpread, normal);
  return normal;
}

bool Solve(const Matrix& hessian, double damping, const Vector& rhs, Vector& solution) {
  const Vector scale = hessian.diagonal().cwiseMax(1e-12).cwiseSqrt().cwiseInverse();
  Matrix scaled = scale.asDiagonal() * hessian * scale.asDiagonal();
  scaled.diagonal().array() += damping + 1e-9;
  const Eigen::LLT<Matrix> llt(scaled);
  if (llt.info() != Eigen::Success) return false;
  solution = scale.asDiagonal() * llt.solve(scale.asDiagonal() * rhs);
  return solution.allFinite();
}

State Stepped(State state, Vector step) {
  const double reach = std::max({step.head<3>().cwiseAbs().maxCoeff(), std::abs(step[kPlace]),
                                 std::abs(step[kAngle]) * state.ball.values[P::kRadius]});
  if (reach > kLongestStep_px) step *= kLongestStep_px / reach;
  auto& p = state.ball.values;
  p += step.head<P::kNumParameters>();
  p[P::kRadius] = std::max(p[P::kRadius], 0.8);
  p[P::kBlur] = std::clamp(p[P::kBlur], 0.3, std::max(1.0, 0.5 * p[P::kRadius]));
  p[P::kShading] = std::clamp(p[P::kShading], -0.5, 0.95);
  state.edge.angle_rad += step[kAngle];
  state.edge.place_px += step[kPlace];
  state.edge.contrast_dn += step[kContrast];
  return state;
}

/// Computes the shares of a disc and of its limb that the edge leaves.
void MeasureHidden(const State& state, CutFit& fit) {
  const Eigen::Vector2d normal(std::cos(state.edge.angle_rad), std::sin(state.edge.angle_rad));
  const double beyond_px = state.edge.place_px - normal.dot(state.ball.values.head<2>());
  const double x = std::clamp(beyond_px / state.ball.values[P::kRadius], -1.0, 1.0);
  fit.hidden_share = (std::acos(x) - x * std::sqrt(1 - x * x)) / kPi;
  fit.arc_share = 1 - std::acos(x) / kPi;
}

}  // namespace

CutFit FitCutBall(const SensorNoise& noise, const BallModel& initial, const CutEdge& edge,
                  BallPatch& patch) {
  CutFit fit;
  State state{initial, edge};
  const double usual_blur_px = initial.values[P::kBlur];
  Normal normal = Evaluate(noise, state, usual_blur_px, patch);
  double damping = 1e-3;
  for (int& n = fit.ball.iterations; n < kMaxIterations && !fit.ball.converged; ++n) {
    Vector step;
    if (!Solve(normal.hessian, damping, normal.gradient, step)) break;
    fit.ball.converged = step.dot(normal.gradient) < kConverged;
    const State next = Stepped(state, step);
    const Normal there = Evaluate(noise, next, usual_blur_px, patch);
    const bool better = there.cost < normal.cost;
    damping = better ? 0.1 * damping : std::max(10 * damping, 1e-4);
    if (!better) continue;
    state = next;
    normal = there;
  }
  const Eigen::LLT<Matrix> llt(normal.hessian);
  fit.ball.model = state.ball;
  fit.ball.chi2 = normal.chi2;
  fit.ball.dof = normal.used - kAll + 2;  // the ball is round
  fit.ball.converged = fit.ball.converged && llt.info() == Eigen::Success && fit.ball.dof > 0;
  if (fit.ball.converged) {
    const Matrix covariance = llt.solve(Matrix::Identity());
    fit.ball.covariance = covariance.topLeftCorner<P::kNumParameters, P::kNumParameters>();
  }
  fit.edge = state.edge;
  fit.cost = normal.cost;
  MeasureHidden(state, fit);
  return fit;
}

}  // namespace stereomotion
