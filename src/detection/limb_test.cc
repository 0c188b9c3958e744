#include "limb_test.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "ball_columns.h"
#include "ball_equations.h"
#include "multiversion.h"

namespace stereomotion {
namespace {

using F = FitParameters;
using P = BallModel;

/// Terms: cos and sin of harmonics 1 (the centre), 3 and 5.
constexpr int kTerms = 6;
constexpr int kCentre = 2;
/// Farther from the limb than this the blur leaves nothing of it.
constexpr float kReach_blurs = 3.5F;
/// χ² that one ball in fifty shows: then the prediction is made anew.
constexpr double kWorthExactness = 12;

/// Columns: the terms, the residual, and zeros, for `GramMatrix` takes them by fours.
constexpr int kColumns = 8;

/// Writes the terms of a pixel whose outward normal is (x, y), of unit length, at a limb of such
/// strength (its grey value's change with the radius, over σ, in any unit).
STEREOMOTION_INLINE void WriteTerms(float x, float y, float strength, float* out,
                                    std::ptrdiff_t gap) {
  const float c2 = x * x - y * y, s2 = 2 * x * y;
  const float c3 = x * c2 - y * s2, s3 = x * s2 + y * c2;
  out[0] = strength * x;
  out[gap] = strength * y;
  out[2 * gap] = strength * c3;
  out[3 * gap] = strength * s3;
  out[4 * gap] = strength * (c3 * c2 - s3 * s2);
  out[5 * gap] = strength * (s3 * c2 + c3 * s2);
}

STEREOMOTION_MULTIVERSION
void FillStill(const BallModel::Vector& ball, const PlaneAndNoise& noise, const EdgeTable& table,
               const BallColumns& c) {
  const BallOutline o(ball);
  const auto center_u = static_cast<float>(ball[P::kU]), center_v = static_cast<float>(ball[P::kV]);
  const std::ptrdiff_t gap = c.gap;
  float* __restrict out = c.out;
#pragma omp simd
  for (int i = 0; i < c.size; ++i) {
    const float x = c.u[i] - center_u, y = c.v[i] - center_v;
    const float place = std::sqrt(o.m_uu * x * x + o.m_vv * y * y + 2 * o.m_uv * x * y);
    const float depth = (o.radius - place) * o.per_blur;
    const float per_r = ReciprocalRoot(x * x + y * y + kSmallestDistance2_px2);
    const float signal = c.model[i] > noise.black ? c.model[i] - noise.black : 0.0F;
    const float per_sigma = ReciprocalRoot(signal * noise.per_gain + noise.floor_dn2);
    const float near = std::abs(depth) > kReach_blurs ? 0.0F : per_sigma;
    const float used = c.grey[i] >= noise.saturation ? 0.0F : near;
    WriteTerms(x * per_r, y * per_r, used * table.At(depth).slope, out + i, gap);
    out[kTerms * gap + i] = per_sigma * (c.grey[i] - c.model[i]);
  }
}

/// The columns of a smear's fit hold the change with the centre and the residual; they are
/// overwritten.
STEREOMOTION_MULTIVERSION
void FillSmeared(const BallColumns& c) {
  const std::ptrdiff_t gap = c.gap;
  float* out = c.out;
#pragma omp simd
  for (int i = 0; i < c.size; ++i) {
    const float by_u = out[P::kU * gap + i], by_v = out[P::kV * gap + i];
    const float residual = out[F::kNum * gap + i];
    const float strength = std::sqrt(by_u * by_u + by_v * by_v);
    const float per_strength = strength > 0 ? 1 / strength : 0.0F;
    WriteTerms(by_u * per_strength, by_v * per_strength, strength, out + i, gap);
    out[kTerms * gap + i] = residual;
  }
}

BallColumns ColumnsOf(BallPatch& patch) {
  const int size = LinearizedSize(patch);
  return {size,
          size,
          patch.u.data(),
          patch.v.data(),
          patch.grey.data(),
          patch.model.data(),
          patch.depth.data(),
          LinearizedColumn(patch, 0)};
}

/// Computes what the harmonics beyond the centre win.
double GainOf(const BallColumns& c, int pixels) {
  std::fill_n(c.out + (kColumns - 1) * c.gap, c.size, 0.0F);
  for (int k = 0; k <= kTerms; ++k) {
    std::fill(c.out + k * c.gap + pixels, c.out + k * c.gap + c.size, 0.0F);
  }
  Eigen::Matrix<float, kColumns, kColumns, Eigen::RowMajor> gram;
  MultiplyColumns(c, kColumns, gram.data());
  // Only the upper triangle of the products is defined, and Eigen's factor wants the lower one.
  const Eigen::Matrix<double, kTerms, kTerms> hessian =
      gram.topLeftCorner<kTerms, kTerms>().transpose().cast<double>();
  const Eigen::Matrix<double, kTerms, 1> gradient = gram.col(kTerms).head<kTerms>().cast<double>();
  const Eigen::LLT<Eigen::Matrix<double, kTerms, kTerms>> all(hessian);
  const Eigen::LLT<Eigen::Matrix2d> centre(hessian.topLeftCorner<kCentre, kCentre>());
  if (all.info() != Eigen::Success || centre.info() != Eigen::Success) return 0;
  return gradient.dot(all.solve(gradient)) -
         gradient.head<kCentre>().dot(centre.solve(gradient.head<kCentre>()));
}

/// Tests what the patch's prediction leaves at the limb of a ball without smear.
double AsymmetryOfStill(const SensorNoise& noise, const BallFit& fit, BallPatch& patch) {
  const BallColumns c = ColumnsOf(patch);
  FillStill(fit.model.values, PlaneAndNoise(F::FromModel(fit.model), noise), EdgeTable::Get(), c);
  return GainOf(c, patch.size);
}

/// A smear's limb is where the grey value changes with the centre, and in that direction.
double AsymmetryOfSmeared(const SensorNoise& noise, const BallFit& fit, BallPatch& patch) {
  BallEquations equations;
  LinearizeBall(noise, F::FromModel(fit.model), F::kNum, patch, equations);
  const BallColumns c = ColumnsOf(patch);
  FillSmeared(c);
  return GainOf(c, patch.size);
}

}  // namespace

double LimbAsymmetry(const SensorNoise& noise, const BallFit& fit, BallPatch& patch) {
  if (!fit.converged || patch.size == 0) return 0;
  if (!fit.model.smear_px.isZero()) return AsymmetryOfSmeared(noise, fit, patch);
  const double asymmetry = AsymmetryOfStill(noise, fit, patch);
  if (asymmetry < kWorthExactness) return asymmetry;
  // The fit's last prediction may be that of a trial.
  BallEquations equations;
  const int active = fit.model.light_per_px.isZero() ? P::kNumParameters : F::kNum;
  LinearizeBall(noise, F::FromModel(fit.model), active, patch, equations);
  return AsymmetryOfStill(noise, fit, patch);
}

}  // namespace stereomotion
