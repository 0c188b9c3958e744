#include "rod_fit_equations.h"

#include "multiversion.h"

namespace stereomotion {
namespace {

constexpr int kBall = RodFitState::kBall;
/// A parameter of which the data tell less (σ > 1 px, rad, DN), all others known, is left alone.
constexpr double kLeastInformation = 1;

const float* Column(const BallPatch& patch, const RodPatch& rod_patch, int k) {
  return k < kBall ? patch.jacobian.col(k).data() : rod_patch.jacobian.col(k - kBall).data();
}

STEREOMOTION_MULTIVERSION
float WeighColumn(int size, const float* __restrict weight, const float* __restrict grey,
                  const float* __restrict model, const float* __restrict column,
                  float* __restrict weighted) {
  float pull = 0;
#pragma omp simd reduction(+ : pull)
  for (int i = 0; i < size; ++i) {
    weighted[i] = weight[i] * column[i];
    pull += weighted[i] * (grey[i] - model[i]);
  }
  return pull;
}

STEREOMOTION_MULTIVERSION
float Dot(int size, const float* __restrict a, const float* __restrict b) {
  float sum = 0;
#pragma omp simd reduction(+ : sum)
  for (int i = 0; i < size; ++i) sum += a[i] * b[i];
  return sum;
}

}  // namespace

RodFitEquations MakeRodFitEquations(BallPatch& patch, const RodPatch& rod_patch) {
  RodFitEquations normal;
  for (int k = 0; k < RodFitState::kAll; ++k) {
    normal.gradient[k] =
        WeighColumn(patch.size, patch.weight.data(), patch.grey.data(), patch.model.data(),
                    Column(patch, rod_patch, k), patch.work.data());
    for (int l = 0; l <= k; ++l) {
      normal.hessian(k, l) = normal.hessian(l, k) =
          Dot(patch.size, patch.work.data(), Column(patch, rod_patch, l));
    }
  }
  for (int k = 0; k < RodFitState::kAll; ++k) {
    if (normal.hessian(k, k) > kLeastInformation) continue;
    normal.hessian.row(k).setZero();
    normal.hessian.col(k).setZero();
    normal.hessian(k, k) = 1;
    normal.gradient[k] = 0;
  }
  return normal;
}

double PatchChi2(const BallPatch& patch) {
  const auto n = patch.size;
  return (patch.weight.head(n) * (patch.grey.head(n) - patch.model.head(n)).square()).sum();
}

}  // namespace stereomotion
