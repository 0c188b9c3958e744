#include "robust_ball_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace stereomotion {
namespace {

using P = BallModel;

/// Cauchy's scale for 95 % efficiency under Gaussian noise, and what is lost then.
constexpr double kCauchyScale = 2.385;
constexpr double kGaussianLoss = 1 / 0.95;
/// Mean ψ' of a ball that is nearly all outliers: bounds the covariance.
constexpr double kSmallestSlope = 0.05;
constexpr int kMaxIterations = 50;
constexpr double kConverged_px = 1e-3;
/// Longest step: a half blur width keeps the redescending weights from jumping to another optimum.
constexpr double kLongestStep_px = 0.5;
/// The limb's outer tail, in units of the blur: beyond it a pixel tells nothing of the ball.
constexpr double kTail = -2.5;

/// A pixel so far over the model shows a glint: twice what dots of uneven paint show. Its blur
/// reaches so many standard deviations.
constexpr double kGlint_sigma = 10;
constexpr double kGlintTail_blurs = 2;

constexpr int kFree = 6;
constexpr std::array<int, kFree> kParameters = {P::kU,     P::kV,      P::kAmplitude,
                                                P::kLevel, P::kSlopeU, P::kSlopeV};
using Vector = Eigen::Matrix<double, kFree, 1>;
using Matrix = Eigen::Matrix<double, kFree, kFree>;

/// Holds one pass over the patch.
struct Sums {
  Matrix weighted = Matrix::Zero();  ///< Σ w J Jᵀ / σ²
  Matrix fisher = Matrix::Zero();    ///< Σ J Jᵀ / σ²
  Vector gradient = Vector::Zero();
  double chi2 = 0, psi2 = 0, psi_slope = 0;  ///< the last two: over the ball's own pixels
  int used = 0, inside = 0;
};

Sums Accumulate(const BallModel& model, const SensorNoise& noise, BallPatch& patch) {
  EvaluateBallModel(model, patch);
  WeighPatch(noise, patch);
  Sums sums;
  for (int i = 0; i < patch.size; ++i) {
    if (!(patch.weight[i] > 0)) continue;
    Vector row;
    for (int k = 0; k < kFree; ++k) row[k] = patch.jacobian(i, kParameters[k]);
    const double information = patch.weight[i];
    const double residual = patch.grey[i] - patch.model[i];
    const double t2 = residual * residual * information;
    const double s = t2 / (kCauchyScale * kCauchyScale);
    const double weight = 1 / (1 + s);
    sums.weighted.noalias() += weight * information * row * row.transpose();
    sums.fisher.noalias() += information * row * row.transpose();
    sums.gradient.noalias() += weight * information * residual * row;
    sums.chi2 += t2;
    ++sums.used;
    if (patch.depth[i] < kTail) continue;
    sums.psi2 += weight * weight * t2;
    sums.psi_slope += weight * weight * (1 - s);
    ++sums.inside;
  }
  return sums;
}

/// Removes the pixels of glints: those far brighter than the model and, for the lens blurs a glint
/// like everything, those around them.
void RemoveGlints(double blur_px, BallPatch& patch) {
  std::vector<bool> keep(static_cast<std::size_t>(patch.size), true);
  const double reach_px = kGlintTail_blurs * blur_px;
  for (int g = 0; g < patch.size; ++g) {
    const double residual = patch.grey[g] - patch.model[g];
    if (!(residual * std::sqrt(patch.weight[g]) > kGlint_sigma)) continue;
    for (int i = 0; i < patch.size; ++i) {
      if (std::hypot(patch.u[i] - patch.u[g], patch.v[i] - patch.v[g]) < reach_px) keep[i] = false;
    }
  }
  int n = 0;
  for (int i = 0; i < patch.size; ++i) {
    if (!keep[i]) continue;
    patch.u[n] = patch.u[i];
    patch.v[n] = patch.v[i];
    patch.grey[n++] = patch.grey[i];
  }
  patch.size = n;
}

/// Climbs to the M-estimate; false: does not converge.
bool Climb(const SensorNoise& noise, double max_shift_px, BallModel& model, BallPatch& patch) {
  const Eigen::Vector2d start_px = model.values.head<2>();
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    const Sums sums = Accumulate(model, noise, patch);
    const Eigen::LDLT<Matrix> ldlt(sums.weighted);
    if (ldlt.info() != Eigen::Success || !ldlt.isPositive()) return false;
    Vector step = ldlt.solve(sums.gradient);
    const double reach = step.head<2>().norm();
    if (!std::isfinite(reach)) return false;
    if (reach > kLongestStep_px) step *= kLongestStep_px / reach;
    for (int k = 0; k < kFree; ++k) model.values[kParameters[k]] += step[k];
    if (!(model.values[P::kAmplitude] > 0)) return false;  // dark: no ball
    if ((model.values.head<2>() - start_px).norm() > max_shift_px) return false;
    if (reach < kConverged_px) return true;
  }
  return false;
}

}  // namespace

std::optional<RobustBallFit> FitBallRobustly(const SensorNoise& noise, const BallModel& initial,
                                             double max_shift_px, BallPatch& patch) {
  RobustBallFit fit;
  fit.model = initial;
  if (!Climb(noise, max_shift_px, fit.model, patch)) return std::nullopt;
  const int all = patch.size;
  Accumulate(fit.model, noise, patch);
  RemoveGlints(fit.model.values[P::kBlur], patch);
  if (patch.size < all && !Climb(noise, max_shift_px, fit.model, patch)) return std::nullopt;
  const Sums sums = Accumulate(fit.model, noise, patch);
  const Eigen::LDLT<Matrix> fisher(sums.fisher);
  if (fisher.info() != Eigen::Success || !fisher.isPositive()) return std::nullopt;
  const Matrix covariance = fisher.solve(Matrix::Identity());
  const double n = std::max(sums.inside, 1);
  const double slope = std::max(sums.psi_slope / n, kSmallestSlope);
  fit.center_covariance_px2 =
      covariance.topLeftCorner<2, 2>() * std::max(sums.psi2 / n / (slope * slope), kGaussianLoss);
  fit.amplitude_sigma_dn = std::sqrt(covariance(2, 2));
  fit.chi2_dof = sums.chi2 / std::max(sums.used - kFree, 1);
  return fit;
}

}  // namespace stereomotion
