#include "ball_model.h"

#include <algorithm>
#include <cmath>

#include "edge_table.h"
#include "multiversion.h"

namespace stereomotion {
namespace {

/// Keeps the direction defined at the very centre.
constexpr float kSmallestDistance2_px2 = 1e-6F;

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
void EvaluateColumns(const Eigen::Matrix<float, BallModel::kNumParameters, 1>& p,
                     const EdgeTable& table, const Columns& c) {
  using P = BallModel;
  const float center_u = p[P::kU];
  const float center_v = p[P::kV];
  const float m_uu = 1.0F - 2.0F * p[P::kStretch1];
  const float m_vv = 1.0F + 2.0F * p[P::kStretch1];
  const float m_uv = -2.0F * p[P::kStretch2];
  const float radius = p[P::kRadius];
  const float blur = p[P::kBlur];
  const float epsilon = blur / radius;
  const float q = p[P::kShading];
  const float amplitude = p[P::kAmplitude];
  const float level = p[P::kLevel];
  const float slope_u = p[P::kSlopeU];
  const float slope_v = p[P::kSlopeV];
  const std::ptrdiff_t stride = c.stride;
  float* __restrict j = c.jacobian;
#pragma omp simd
  for (int i = 0; i < c.size; ++i) {
    const float x = c.u[i] - center_u;
    const float y = c.v[i] - center_v;
    const float r2 = x * x + y * y + kSmallestDistance2_px2;
    const float s2 = m_uu * x * x + m_vv * y * y + 2.0F * m_uv * x * y + kSmallestDistance2_px2;
    const float s = std::sqrt(s2);
    // (R − s) is the distance in the stretched plane; r/s turns it back into pixels.
    const float r = std::sqrt(r2);
    const float scale = r / (s * blur);
    const float z = scale * (radius - s);
    const EdgeValue edge = table.At(z);
    const float inside = z > 0.0F ? z : 0.0F;
    const float cosine = std::sqrt(epsilon * (2.0F * edge.height - epsilon * inside * inside));
    const float shade = 1.0F - q + q * cosine;
    const float d_cosine_dz = epsilon * (edge.height_slope - epsilon * inside) / cosine;
    const float d_cosine_de = (edge.height - epsilon * inside * inside) / cosine;
    const float dz = amplitude * (edge.slope * shade + edge.coverage * q * d_cosine_dz);
    const float de = amplitude * edge.coverage * q * d_cosine_de;
    const float per_s = dz * scale * radius / s2;
    const float per_r = dz * (radius - s) / (s * blur * r);
    j[P::kU * stride + i] = per_s * (m_uu * x + m_uv * y) - per_r * x;
    j[P::kV * stride + i] = per_s * (m_uv * x + m_vv * y) - per_r * y;
    j[P::kRadius * stride + i] = dz * scale - de * epsilon / radius;
    j[P::kStretch1 * stride + i] = per_s * (x * x - y * y);
    j[P::kStretch2 * stride + i] = per_s * 2.0F * x * y;
    j[P::kBlur * stride + i] = -dz * z / blur + de / radius;
    j[P::kAmplitude * stride + i] = edge.coverage * shade;
    j[P::kShading * stride + i] = amplitude * edge.coverage * (cosine - 1.0F);
    j[P::kLevel * stride + i] = 1.0F;
    j[P::kSlopeU * stride + i] = c.u[i];
    j[P::kSlopeV * stride + i] = c.v[i];
    c.depth[i] = z;
    c.model[i] = amplitude * edge.coverage * shade + level + slope_u * c.u[i] + slope_v * c.v[i];
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

void BallPatch::Resize(int capacity) {
  size = capacity;
  if (capacity <= u.size()) return;
  for (Eigen::ArrayXf* column : {&u, &v, &grey, &model, &depth, &weight, &work})
    column->resize(capacity);
  jacobian.resize(capacity, BallModel::kNumParameters);
}

void EvaluateBallModel(const BallModel& ball, BallPatch& patch) {
  EvaluateColumns(ball.values.cast<float>(), EdgeTable::Get(),
                  {patch.size, patch.jacobian.rows(), patch.u.data(), patch.v.data(),
                   patch.model.data(), patch.depth.data(), patch.jacobian.data()});
}

void WeighPatch(const SensorNoise& noise, BallPatch& patch) {
  WeighColumns(noise, patch.size, patch.grey.data(), patch.model.data(), patch.weight.data());
}

}  // namespace stereomotion
