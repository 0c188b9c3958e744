#include "fit_ball.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "multiversion.h"

namespace stereomotion {
namespace {

constexpr int kMaxIterations = 30;
/// χ² that a further step could still win; 1e-3 leaves every parameter within 0.03 σ of the
/// optimum.
constexpr double kConverged = 1e-3;
/// A step damped more than this is too short to tell how much a full one would win.
constexpr double kTrustedDamping = 1e-2;
/// χ² is summed in single precision; whether so small a share of it was won cannot be told.
constexpr double kRounding = 1e-4;

/// The limb's shading is nearly one with blur, radius and amplitude where a ball is small or dim.
/// This keeps the search where real balls are; it enters the steps, never the covariance, and by
/// symmetry not the centre.
constexpr double kUsualShading = 0.15;
constexpr double kUsualShadingSpread = 0.15;

struct NormalEquations {
  BallModel::Matrix hessian;
  BallModel::Vector gradient;  ///< JᵀW(measured − model)
};

STEREOMOTION_MULTIVERSION
void AccumulateColumns(const BallPatch& patch, float* __restrict weighted,
                       double* __restrict hessian, double* __restrict gradient) {
  constexpr int kN = BallModel::kNumParameters;
  const int size = patch.size;
  const float* __restrict weight = patch.weight.data();
  const float* __restrict grey = patch.grey.data();
  const float* __restrict model = patch.model.data();
  for (int k = 0; k < kN; ++k) {
    const float* __restrict column = patch.jacobian.col(k).data();
    float pull = 0;
#pragma omp simd reduction(+ : pull)
    for (int i = 0; i < size; ++i) {
      weighted[i] = weight[i] * column[i];
      pull += weighted[i] * (grey[i] - model[i]);
    }
    gradient[k] = pull;
    for (int l = 0; l <= k; ++l) {
      const float* __restrict other = patch.jacobian.col(l).data();
      float sum = 0;
#pragma omp simd reduction(+ : sum)
      for (int i = 0; i < size; ++i) sum += weighted[i] * other[i];
      hessian[k * kN + l] = hessian[l * kN + k] = sum;
    }
  }
}

NormalEquations Accumulate(BallPatch& patch) {
  NormalEquations normal;
  AccumulateColumns(patch, patch.work.data(), normal.hessian.data(), normal.gradient.data());
  return normal;
}

STEREOMOTION_MULTIVERSION
double Chi2(const BallPatch& patch) {
  const float* __restrict weight = patch.weight.data();
  const float* __restrict grey = patch.grey.data();
  const float* __restrict model = patch.model.data();
  float chi2 = 0;
#pragma omp simd reduction(+ : chi2)
  for (int i = 0; i < patch.size; ++i) {
    const float residual = grey[i] - model[i];
    chi2 += weight[i] * residual * residual;
  }
  return chi2;
}

double ShadingCost(const BallModel& model) {
  const double off = (model.values[BallModel::kShading] - kUsualShading) / kUsualShadingSpread;
  return off * off;
}

NormalEquations WithUsualShading(NormalEquations normal, const BallModel& model) {
  constexpr double kWeight = 1 / (kUsualShadingSpread * kUsualShadingSpread);
  constexpr int kQ = BallModel::kShading;
  normal.hessian(kQ, kQ) += kWeight;
  normal.gradient[kQ] += kWeight * (kUsualShading - model.values[kQ]);
  return normal;
}

/// Keeps a step inside the model's domain: the outline an ellipse, blur and radius positive.
BallModel::Vector StepInsideDomain(const BallModel::Vector& from, BallModel::Vector step) {
  using P = BallModel;
  const double radius = from[P::kRadius];
  const double reach =
      std::max({std::abs(step[P::kU]), std::abs(step[P::kV]), std::abs(step[P::kRadius])}) /
      (0.5 * radius);
  if (reach > 1) step /= reach;
  BallModel::Vector to = from + step;
  to[P::kRadius] = std::max(to[P::kRadius], 0.4);
  to[P::kBlur] = std::clamp(to[P::kBlur], 0.3, std::max(1.0, 0.8 * to[P::kRadius]));
  to[P::kShading] = std::clamp(to[P::kShading], -0.5, 0.95);
  to[P::kStretch1] = std::clamp(to[P::kStretch1], -0.45, 0.45);
  to[P::kStretch2] = std::clamp(to[P::kStretch2], -0.45, 0.45);
  const double stretch = std::hypot(to[P::kStretch1], to[P::kStretch2]);
  if (stretch > 0.45) to.segment<2>(P::kStretch1) *= 0.45 / stretch;
  return to;
}

/// Solves (H + λ diag H) x = g in units in which diag H is 1: the parameters' scales differ by 1e6.
struct ScaledSolver {
  explicit ScaledSolver(const BallModel::Matrix& hessian, double damping)
      : scale(hessian.diagonal().cwiseMax(1e-30).cwiseSqrt().cwiseInverse()) {
    BallModel::Matrix scaled = scale.asDiagonal() * hessian * scale.asDiagonal();
    scaled.diagonal().array() += damping;
    llt.compute(scaled);
  }
  [[nodiscard]] bool ok() const { return llt.info() == Eigen::Success; }
  template <class M>
  [[nodiscard]] auto Solve(const M& rhs) const {
    return (scale.asDiagonal() * llt.solve(scale.asDiagonal() * rhs)).eval();
  }
  BallModel::Vector scale;
  Eigen::LLT<BallModel::Matrix> llt;
};

/// Counts which share of the pixels inside the fitted outline reach half the ball's brightness.
double VisibleFraction(const BallPatch& patch, const BallModel& model) {
  const auto n = patch.size;
  const auto half = static_cast<float>(model.values[BallModel::kLevel] +
                                       0.5 * model.values[BallModel::kAmplitude]);
  // A pixel at the limb is half bright by itself: one blur width inwards it is clearly ball.
  const auto deep = patch.depth.head(n) > 1.0F;
  const auto bright = deep && patch.grey.head(n) > half;
  return deep.any() ? static_cast<double>(bright.count()) / static_cast<double>(deep.count()) : 1.0;
}

void Finish(const BallPatch& patch, const NormalEquations& normal, BallFit& fit) {
  fit.chi2 = Chi2(patch);
  const auto used = static_cast<int>((patch.weight.head(patch.size) > 0.0F).count());
  fit.dof = used - BallModel::kNumParameters;
  fit.visible_fraction = VisibleFraction(patch, fit.model);
  const ScaledSolver undamped(normal.hessian, 0);
  fit.converged = fit.converged && undamped.ok() && fit.dof > 0;
  if (fit.converged) fit.covariance = undamped.Solve(BallModel::Matrix::Identity());
}

}  // namespace

BallFit FitBall(const SensorNoise& noise, const BallModel& initial, BallPatch& patch) {
  BallFit fit;
  fit.model = initial;
  EvaluateBallModel(fit.model, patch);
  WeighPatch(noise, patch);
  double damping = 1e-3;
  NormalEquations normal = Accumulate(patch);
  for (int iteration = 0; iteration < kMaxIterations && !fit.converged; ++iteration) {
    const NormalEquations guided = WithUsualShading(normal, fit.model);
    ++fit.iterations;
    const ScaledSolver solver(guided.hessian, damping);
    if (!solver.ok()) {
      damping = std::max(10 * damping, 1e-6);
      continue;
    }
    const BallModel::Vector step = solver.Solve(guided.gradient);
    fit.converged = damping <= kTrustedDamping && step.dot(guided.gradient) < kConverged;
    if (fit.converged) break;
    const double cost_before = Chi2(patch) + ShadingCost(fit.model);
    const BallModel before = fit.model;
    fit.model.values = StepInsideDomain(before.values, step);
    EvaluateBallModel(fit.model, patch);
    const bool worse = Chi2(patch) + ShadingCost(fit.model) > cost_before;
    if (worse && step.dot(guided.gradient) > kRounding * cost_before) {
      fit.model = before;
      damping = std::max(10 * damping, 1e-4);
      if (damping > 1e8) break;
      EvaluateBallModel(fit.model, patch);
      continue;
    }
    damping *= 0.1;
    WeighPatch(noise, patch);
    normal = Accumulate(patch);
  }
  Finish(patch, normal, fit);
  return fit;
}

}  // namespace stereomotion
