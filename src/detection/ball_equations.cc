#include "ball_equations.h"

#include <algorithm>
#include <cmath>

#include "ball_columns.h"
#include "ball_pixel.h"
#include "censored_normal.h"
#include "edge_table.h"
#include "pixel_order.h"

namespace stereomotion {
namespace {

using F = FitParameters;
using P = BallModel;

constexpr int kMaxColumns = F::kNum + 1;
/// A censored pixel that tells less than this share of an ordinary one is left out of χ².
constexpr double kTellsNothing = 0.05;

/// Cuts the columns down to a range of pixels, in whole vectors.
BallColumns Part(BallColumns c, const PixelRange& range) {
  const int begin = range.begin / BallPatch::kLanes * BallPatch::kLanes;
  c.size = std::min(c.size,
                    (range.end + BallPatch::kLanes - 1) / BallPatch::kLanes * BallPatch::kLanes) -
           begin;
  c.u += begin;
  c.v += begin;
  c.model += begin;
  c.depth += begin;
  c.out += begin;
  return c;
}

void EvaluateExposure(const F::Vector& ball, const PlaneAndNoise& plane, int num_nodes,
                      const PixelOrder& order, const BallColumns& c) {
  std::fill_n(c.out, kMaxColumns * c.gap, 0.0F);
  std::fill_n(c.depth, c.size, 0.0F);
  std::fill_n(c.model, c.size, 0.0F);
  const BallOutline outline(ball.head<P::kNumParameters>());
  const Eigen::Vector2d smear_px = ball.segment<2>(F::kSmearU);
  const int needed = CountNodes(smear_px.norm() / ball[P::kBlur]);
  const QuadratureNodes nodes = GaussLegendre(num_nodes > 0 ? num_nodes : needed);
  // Where a coverage of 3e-7 ends.
  constexpr double kLight_blurs = 5;
  const double stretch = ball.segment<2>(P::kStretch1).norm();
  const double light_px = (ball[P::kRadius] + kLight_blurs * ball[P::kBlur]) /
                          std::sqrt(1 - 2 * std::min(stretch, 0.49));
  for (int k = 0; k < nodes.count; ++k) {
    const Eigen::Vector2f center =
        (ball.head<2>() + 0.5 * nodes.place[k] * smear_px).template cast<float>();
    AddInstant(outline, center.x(), center.y(), static_cast<float>(0.5 * nodes.weight[k]),
               static_cast<float>(0.5 * nodes.place[k]), EdgeTable::Get(),
               Part(c, order.Near(center, light_px, c.size)));
  }
  const Eigen::Vector4d center_and_light(ball[P::kU], ball[P::kV], ball[F::kLightU],
                                         ball[F::kLightV]);
  FinishExposure(center_and_light.cast<float>(), plane, c);
}

/// Replaces what an ordinary pixel would tell by what a bound tells.
void CensorPixel(const SensorNoise& noise, int i, int num_columns, const BallColumns& c,
                 BallEquations& equations) {
  const bool dark = c.grey[i] <= 0.0F;
  const double model = c.model[i];
  const double variance = noise.VarianceDn2(model);
  const double bound = dark ? 0.5 : noise.saturation_dn - 0.5;
  const CensoredNormal pixel =
      CensorNormal(dark ? bound - model : model - bound, variance - 1.0 / 12.0);
  const double residual = c.grey[i] - model;
  const double x = residual / (noise.gain_e_per_dn * variance);
  equations.deviance +=
      pixel.deviance - residual * residual / variance * (1 + x * (x / 6 - 1.0 / 3));
  equations.chi2 -= residual * residual / variance;
  if (pixel.information * variance > kTellsNothing) {
    equations.chi2 += pixel.mean_square;
  } else {
    --equations.used;
  }
  const auto scale = static_cast<float>(std::sqrt(pixel.information * variance));
  for (int k = 0; k < num_columns; ++k) c.out[k * c.gap + i] *= scale;
  c.out[num_columns * c.gap + i] =
      static_cast<float>((dark ? -1 : 1) * pixel.score / std::sqrt(pixel.information));
}

/// Adds the ring's pixels, all of the variance of the patch's middle.
void AddRing(const SensorNoise& noise, const F::Vector& ball, const BackgroundSums& ring,
             BallEquations& equations) {
  const double weight = 1 / noise.VarianceDn2(ball[P::kLevel]);
  Eigen::Matrix3d hessian;
  hessian << ring.n, ring.u, ring.v, ring.u, ring.uu, ring.uv, ring.v, ring.uv, ring.vv;
  const Eigen::Vector3d data(ring.grey, ring.u_grey, ring.v_grey);
  const Eigen::Vector3d plane = ball.segment<3>(P::kLevel);
  const Eigen::Vector3d predicted = hessian * plane;
  const double chi2 = weight * (ring.grey2 - 2 * plane.dot(data) + plane.dot(predicted));
  equations.hessian.block<3, 3>(P::kLevel, P::kLevel) += weight * hessian;
  equations.gradient.segment<3>(P::kLevel) += weight * (data - predicted);
  equations.chi2 += chi2;
  equations.deviance += chi2;
  equations.used += static_cast<int>(ring.n);
}

void CopyGram(const float* gram, int num_active, int num_columns, BallEquations& equations) {
  for (int k = 0; k < num_active; ++k) {
    equations.gradient[k] = gram[k * num_columns + num_active];
    for (int l = k; l < num_active; ++l) {
      equations.hessian(k, l) = equations.hessian(l, k) = gram[k * num_columns + l];
    }
  }
}

BallColumns PointAt(BallPatch& patch) {
  const int size = LinearizedSize(patch);
  for (Eigen::ArrayXf* column : {&patch.u, &patch.v, &patch.grey, &patch.model, &patch.depth}) {
    if (column->size() < size) column->conservativeResize(size);
  }
  // The spare places repeat the last pixel, so that the loops need no remainder.
  for (int i = patch.size; i < size; ++i) {
    patch.u[i] = patch.u[patch.size - 1];
    patch.v[i] = patch.v[patch.size - 1];
    patch.grey[i] = patch.grey[patch.size - 1];
  }
  return {size,
          size,
          patch.u.data(),
          patch.v.data(),
          patch.grey.data(),
          patch.model.data(),
          patch.depth.data(),
          LinearizedColumn(patch, 0)};
}

bool IsBound(const SensorNoise& noise, float grey) {
  return grey <= 0.0F || grey >= static_cast<float>(noise.saturation_dn);
}

}  // namespace

FitParameters::Vector FitParameters::FromModel(const BallModel& ball) {
  Vector values;
  values << ball.values, ball.smear_px, ball.light_per_px;
  return values;
}

BallModel FitParameters::ToModel(const Vector& values) {
  BallModel ball;
  ball.values = values.head<BallModel::kNumParameters>();
  ball.smear_px = values.segment<2>(kSmearU);
  ball.light_per_px = values.segment<2>(kLightU);
  return ball;
}

int LinearizedSize(const BallPatch& patch) {
  return (patch.size + BallPatch::kLanes - 1) / BallPatch::kLanes * BallPatch::kLanes;
}

float* LinearizedColumn(BallPatch& patch, int k) {
  const auto size = static_cast<std::size_t>(LinearizedSize(patch));
  const std::size_t need = kMaxColumns * size;
  if (patch.fit_columns.size() < need) patch.fit_columns.resize(need);
  return patch.fit_columns.data() + static_cast<std::size_t>(k) * size;
}

void LinearizeBall(const SensorNoise& noise, const FitParameters::Vector& ball, int num_active,
                   BallPatch& patch, BallEquations& equations, int num_nodes) {
  const BallColumns c = PointAt(patch);
  const PlaneAndNoise plane(ball, noise);
  if (num_active == P::kNumParameters) {
    EvaluateBasic(BallOutline(ball.head<P::kNumParameters>()), static_cast<float>(ball[P::kU]),
                  static_cast<float>(ball[P::kV]), plane, EdgeTable::Get(), c);
  } else {
    EvaluateExposure(ball, plane, num_nodes, patch.order, c);
  }
  const PixelSums sums = SumResiduals(plane, patch.size, c.grey, c.model);
  equations.chi2 = sums.chi2;
  equations.deviance = sums.deviance;
  equations.used = patch.size;
  for (int i = 0; sums.bounds > 0 && i < patch.size; ++i) {
    if (IsBound(noise, c.grey[i])) CensorPixel(noise, i, num_active, c, equations);
  }
  for (int k = 0; k <= num_active; ++k) {
    std::fill(c.out + k * c.gap + patch.size, c.out + k * c.gap + c.size, 0.0F);
  }
  float gram[kMaxColumns * kMaxColumns];
  MultiplyColumns(c, num_active + 1, gram);
  CopyGram(gram, num_active, num_active + 1, equations);
  if (patch.ring.n > 0) AddRing(noise, ball, patch.ring, equations);
}

}  // namespace stereomotion
