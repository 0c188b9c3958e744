#include "ball_model.h"

#include <algorithm>
#include <cmath>

#include "ball_pixel.h"
#include "edge_table.h"
#include "multiversion.h"

namespace stereomotion {
namespace {

/// Points at the columns of a patch, for the loops that the compiler vectorises.
struct Columns {
  int size;
  std::ptrdiff_t stride;  ///< between two columns of the Jacobian
  const float* __restrict u;
  const float* __restrict v;
  float* __restrict model;
  float* __restrict depth;
  float* __restrict jacobian;
};

STEREOMOTION_MULTIVERSION
void EvaluateColumns(const BallOutline& ball, const Eigen::Matrix<float, 5, 1>& place_and_light,
                     const EdgeTable& table, const Columns& c) {
  using P = BallModel;
  const float center_u = place_and_light[0];
  const float center_v = place_and_light[1];
  const float level = place_and_light[2];
  const float slope_u = place_and_light[3];
  const float slope_v = place_and_light[4];
  const std::ptrdiff_t stride = c.stride;
  float* __restrict j = c.jacobian;
#pragma omp simd
  for (int i = 0; i < c.size; ++i) {
    const BallPixel pixel = EvaluateBallPixel(ball, table, c.u[i] - center_u, c.v[i] - center_v);
    j[P::kU * stride + i] = pixel.by_u;
    j[P::kV * stride + i] = pixel.by_v;
    j[P::kRadius * stride + i] = pixel.by_radius;
    j[P::kStretch1 * stride + i] = pixel.by_stretch1;
    j[P::kStretch2 * stride + i] = pixel.by_stretch2;
    j[P::kBlur * stride + i] = pixel.by_blur;
    j[P::kAmplitude * stride + i] = pixel.by_amplitude;
    j[P::kShading * stride + i] = pixel.by_shading;
    j[P::kLevel * stride + i] = 1.0F;
    j[P::kSlopeU * stride + i] = c.u[i];
    j[P::kSlopeV * stride + i] = c.v[i];
    c.depth[i] = pixel.depth;
    c.model[i] = pixel.grey + level + slope_u * c.u[i] + slope_v * c.v[i];
  }
}

STEREOMOTION_MULTIVERSION
void WeighColumns(const SensorNoise& noise, int size, const float* __restrict grey,
                  const float* __restrict model, float* __restrict weight) {
  const auto saturation = static_cast<float>(noise.saturation_dn);
  const auto black = static_cast<float>(noise.black_dn);
  const auto per_gain = static_cast<float>(1.0 / noise.gain_e_per_dn);
  const auto floor_dn2 = static_cast<float>(noise.VarianceDn2(noise.black_dn));
#pragma omp simd
  for (int i = 0; i < size; ++i) {
    const float signal = model[i] > black ? model[i] - black : 0.0F;
    const float measured = 1.0F / (signal * per_gain + floor_dn2);
    const bool too_bright = (grey[i] >= saturation) & (model[i] >= saturation);
    const bool too_dark = (grey[i] <= 0.0F) & (model[i] <= 0.0F);
    weight[i] = too_bright | too_dark ? 0.0F : measured;
  }
}

}  // namespace

void BackgroundSums::Add(double u_px, double v_px, double grey_dn) {
  n += 1;
  u += u_px;
  v += v_px;
  uu += u_px * u_px;
  uv += u_px * v_px;
  vv += v_px * v_px;
  grey += grey_dn;
  u_grey += u_px * grey_dn;
  v_grey += v_px * grey_dn;
  grey2 += grey_dn * grey_dn;
}

void BallPatch::Resize(int capacity) {
  size = capacity;
  ring = {};
  order.Forget();
  const int whole = capacity + kLanes;
  if (whole <= u.size()) return;
  for (Eigen::ArrayXf* column : {&u, &v, &grey, &model, &depth, &weight, &work})
    column->resize(whole);
  jacobian.resize(capacity, BallModel::kNumParameters);
}

void EvaluateBallModel(const BallModel& ball, BallPatch& patch) {
  using P = BallModel;
  const auto& p = ball.values;
  const Eigen::Matrix<double, 5, 1> place_and_light(
      {p[P::kU], p[P::kV], p[P::kLevel], p[P::kSlopeU], p[P::kSlopeV]});
  EvaluateColumns(BallOutline(p), place_and_light.cast<float>(), EdgeTable::Get(),
                  {patch.size, patch.jacobian.rows(), patch.u.data(), patch.v.data(),
                   patch.model.data(), patch.depth.data(), patch.jacobian.data()});
}

void WeighPatch(const SensorNoise& noise, BallPatch& patch) {
  WeighColumns(noise, patch.size, patch.grey.data(), patch.model.data(), patch.weight.data());
}

}  // namespace stereomotion
