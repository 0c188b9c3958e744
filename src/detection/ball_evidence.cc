#include "ball_evidence.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "gram_matrix.h"
#include "multiversion.h"

namespace stereomotion {
namespace {

using F = FitParameters;
using P = BallModel;

constexpr int kBasic = P::kNumParameters;
constexpr int kTerms = 4;  ///< light u, v; blur along cos 2φ, sin 2φ
constexpr int kColumns = kBasic + 1 + kTerms;

/// Writes the derivatives by the terms, behind the residuals.
STEREOMOTION_MULTIVERSION
void WriteTerms(int size, std::ptrdiff_t gap, float center_u, float center_v, float amplitude,
                const float* __restrict u, const float* __restrict v, float* __restrict columns) {
  const float* __restrict by_amplitude = columns + P::kAmplitude * gap;
  const float* __restrict by_blur = columns + P::kBlur * gap;
  float* __restrict out = columns + (kBasic + 1) * gap;
#pragma omp simd
  for (int i = 0; i < size; ++i) {
    const float x = u[i] - center_u;
    const float y = v[i] - center_v;
    const float per_r2 = 1.0F / (x * x + y * y + 1e-6F);
    out[i] = amplitude * x * by_amplitude[i];
    out[gap + i] = amplitude * y * by_amplitude[i];
    out[2 * gap + i] = (x * x - y * y) * per_r2 * by_blur[i];
    out[3 * gap + i] = 2.0F * x * y * per_r2 * by_blur[i];
  }
}

STEREOMOTION_MULTIVERSION
void MultiplyTerms(int size, std::ptrdiff_t gap, const float* __restrict columns,
                   float* __restrict gram) {
  GramMatrix(columns, gap, size, kBasic + 1, kColumns, gram);
}

struct TermEquations {
  Eigen::Matrix<double, kBasic, kTerms> mixed;
  Eigen::Matrix4d hessian;
  Eigen::Vector4d gradient;
};

TermEquations Gather(const float* gram) {
  const auto at = [&](int k, int l) { return double{gram[k * kColumns + l]}; };
  TermEquations terms;
  for (int l = 0; l < kTerms; ++l) {
    const int column = kBasic + 1 + l;
    for (int k = 0; k < kBasic; ++k) terms.mixed(k, l) = at(k, column);
    terms.gradient[l] = at(kBasic, column);
    for (int k = 0; k <= l; ++k) {
      terms.hessian(k, l) = terms.hessian(l, k) = at(kBasic + 1 + k, column);
    }
  }
  return terms;
}

/// A smear of length s widens the limb's variance by s²/24 (1 + cos 2φ) from its own direction.
Eigen::Vector2d SmearOf(const Eigen::Vector2d& blur_harmonic, double blur_px, double radius_px) {
  const double length_px = std::sqrt(48 * blur_px * blur_harmonic.norm());
  const double angle = 0.5 * std::atan2(blur_harmonic.y(), blur_harmonic.x());
  return std::min(length_px, 2 * radius_px) * Eigen::Vector2d(std::cos(angle), std::sin(angle));
}

}  // namespace

BallEvidence TestBall(const BallSearch& search, const Pulls& pulls, BallPatch& patch) {
  const F::Vector from = search.at - search.last_step;
  const int size = LinearizedSize(patch);
  float* columns = LinearizedColumn(patch, 0);
  WriteTerms(size, size, static_cast<float>(from[P::kU]), static_cast<float>(from[P::kV]),
             static_cast<float>(from[P::kAmplitude]), patch.u.data(), patch.v.data(), columns);
  float gram[kColumns * kColumns];
  MultiplyTerms(size, size, columns, gram);
  TermEquations terms = Gather(gram);
  P::Matrix hessian = search.equations.hessian.topLeftCorner<kBasic, kBasic>();
  hessian.diagonal() += pulls.weight.head<kBasic>();
  const Eigen::LLT<P::Matrix> llt(hessian);
  BallEvidence evidence;
  if (llt.info() != Eigen::Success) return evidence;
  const Eigen::Vector4d score =
      terms.gradient - terms.mixed.transpose() * search.last_step.head<kBasic>();
  for (int l = 0; l < kTerms; ++l) {
    Eigen::Matrix<double, kBasic, 1> column = terms.mixed.col(l);
    llt.matrixL().solveInPlace(column);
    terms.mixed.col(l) = column;
  }
  const Eigen::Matrix4d information =
      terms.hessian - terms.mixed.transpose().lazyProduct(terms.mixed);
  const Eigen::Vector2d light = score.head<2>();
  evidence.light_gain = light.dot(information.topLeftCorner<2, 2>().inverse() * light);
  const Eigen::Vector2d blur = score.tail<2>();
  const Eigen::Vector2d harmonic = information.bottomRightCorner<2, 2>().inverse() * blur;
  evidence.smear_gain = blur.dot(harmonic);
  evidence.smear_px = SmearOf(harmonic, from[P::kBlur], from[P::kRadius]);
  return evidence;
}

}  // namespace stereomotion
