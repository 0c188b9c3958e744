#include "ball_columns.h"

#include "gram_matrix.h"
#include "multiversion.h"

namespace stereomotion {
namespace {

using F = FitParameters;
using P = BallModel;

struct WeighedPixel {
  float root;      ///< 1 / σ
  float residual;  ///< in units of σ
  float chi2, deviance;
};

STEREOMOTION_INLINE WeighedPixel Weigh(const PlaneAndNoise& p, float grey, float model) {
  const float signal = model > p.black ? model - p.black : 0.0F;
  const float root = ReciprocalRoot(signal * p.per_gain + p.floor_dn2);
  const float residual = root * (grey - model);
  const float chi2 = residual * residual;
  // Of the quasi-likelihood's 2 V/c² ((1 + x) ln(1 + x) − x), x = c (grey − model) / V, the
  // first terms of the series: enough to tell a better place from a worse one.
  const float x = p.per_gain * residual * root;
  return {root, residual, chi2, chi2 * (1.0F + x * (x * (1.0F / 6.0F) - 1.0F / 3.0F))};
}

}  // namespace

STEREOMOTION_MULTIVERSION
void EvaluateBasic(const BallOutline& ball, float center_u, float center_v,
                   const PlaneAndNoise& plane, const EdgeTable& table, const BallColumns& c) {
  const std::ptrdiff_t gap = c.gap;
  float* __restrict out = c.out;
#pragma omp simd
  for (int i = 0; i < c.size; ++i) {
    const BallPixel pixel = EvaluateBallPixel(ball, table, c.u[i] - center_u, c.v[i] - center_v);
    const float model = pixel.grey + plane.level + plane.slope_u * c.u[i] + plane.slope_v * c.v[i];
    const WeighedPixel weighed = Weigh(plane, c.grey[i], model);
    c.depth[i] = pixel.depth;
    c.model[i] = model;
    out[P::kU * gap + i] = weighed.root * pixel.by_u;
    out[P::kV * gap + i] = weighed.root * pixel.by_v;
    out[P::kRadius * gap + i] = weighed.root * pixel.by_radius;
    out[P::kStretch1 * gap + i] = weighed.root * pixel.by_stretch1;
    out[P::kStretch2 * gap + i] = weighed.root * pixel.by_stretch2;
    out[P::kBlur * gap + i] = weighed.root * pixel.by_blur;
    out[P::kAmplitude * gap + i] = weighed.root * pixel.by_amplitude;
    out[P::kShading * gap + i] = weighed.root * pixel.by_shading;
    out[P::kLevel * gap + i] = weighed.root;
    out[P::kSlopeU * gap + i] = weighed.root * c.u[i];
    out[P::kSlopeV * gap + i] = weighed.root * c.v[i];
    out[P::kNumParameters * gap + i] = weighed.residual;
  }
}

STEREOMOTION_MULTIVERSION
void AddInstant(const BallOutline& ball, float center_u, float center_v, float share, float time,
                const EdgeTable& table, const BallColumns& c) {
  const std::ptrdiff_t gap = c.gap;
  float* __restrict out = c.out;
#pragma omp simd
  for (int i = 0; i < c.size; ++i) {
    const BallPixel pixel = EvaluateBallPixel(ball, table, c.u[i] - center_u, c.v[i] - center_v);
    c.depth[i] += share * pixel.depth;
    c.model[i] += share * pixel.grey;
    out[P::kU * gap + i] += share * pixel.by_u;
    out[P::kV * gap + i] += share * pixel.by_v;
    out[P::kRadius * gap + i] += share * pixel.by_radius;
    out[P::kStretch1 * gap + i] += share * pixel.by_stretch1;
    out[P::kStretch2 * gap + i] += share * pixel.by_stretch2;
    out[P::kBlur * gap + i] += share * pixel.by_blur;
    out[P::kAmplitude * gap + i] += share * pixel.by_amplitude;
    out[P::kShading * gap + i] += share * pixel.by_shading;
    out[F::kSmearU * gap + i] += share * time * pixel.by_u;
    out[F::kSmearV * gap + i] += share * time * pixel.by_v;
  }
}

STEREOMOTION_MULTIVERSION
void FinishExposure(const Eigen::Vector4f& center_and_light, const PlaneAndNoise& plane,
                    const BallColumns& c) {
  const std::ptrdiff_t gap = c.gap;
  float* __restrict out = c.out;
#pragma omp simd
  for (int i = 0; i < c.size; ++i) {
    const float x = c.u[i] - center_and_light[0];
    const float y = c.v[i] - center_and_light[1];
    const float even = c.model[i];
    const float light = 1.0F + center_and_light[2] * x + center_and_light[3] * y;
    const float model =
        light * even + plane.level + plane.slope_u * c.u[i] + plane.slope_v * c.v[i];
    const WeighedPixel weighed = Weigh(plane, c.grey[i], model);
    const float root = weighed.root;
    c.model[i] = model;
    out[P::kU * gap + i] = root * (light * out[P::kU * gap + i] - center_and_light[2] * even);
    out[P::kV * gap + i] = root * (light * out[P::kV * gap + i] - center_and_light[3] * even);
    out[P::kRadius * gap + i] *= root * light;
    out[P::kStretch1 * gap + i] *= root * light;
    out[P::kStretch2 * gap + i] *= root * light;
    out[P::kBlur * gap + i] *= root * light;
    out[P::kAmplitude * gap + i] *= root * light;
    out[P::kShading * gap + i] *= root * light;
    out[P::kLevel * gap + i] = root;
    out[P::kSlopeU * gap + i] = root * c.u[i];
    out[P::kSlopeV * gap + i] = root * c.v[i];
    out[F::kSmearU * gap + i] *= root * light;
    out[F::kSmearV * gap + i] *= root * light;
    out[F::kLightU * gap + i] = root * x * even;
    out[F::kLightV * gap + i] = root * y * even;
    out[F::kNum * gap + i] = weighed.residual;
  }
}

STEREOMOTION_MULTIVERSION
void MultiplyColumns(const BallColumns& c, int num_columns, float* __restrict gram) {
  GramMatrix(c.out, c.gap, c.size, 0, num_columns, gram);
}

STEREOMOTION_MULTIVERSION
PixelSums SumResiduals(const PlaneAndNoise& plane, int size, const float* __restrict grey,
                       const float* __restrict model) {
  float chi2 = 0;
  float deviance = 0;
  int bounds = 0;
#pragma omp simd reduction(+ : chi2, deviance, bounds)
  for (int i = 0; i < size; ++i) {
    const WeighedPixel weighed = Weigh(plane, grey[i], model[i]);
    chi2 += weighed.chi2;
    deviance += weighed.deviance;
    bounds += (grey[i] <= 0.0F) | (grey[i] >= plane.saturation) ? 1 : 0;
  }
  return {chi2, deviance, bounds};
}

}  // namespace stereomotion
