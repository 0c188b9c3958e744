#pragma once

#include <cmath>

#include "ball_model.h"
#include "edge_table.h"
#include "multiversion.h"

namespace stereomotion {

/// Holds what a ball's image needs at every pixel, in single precision.
struct BallOutline {
  explicit BallOutline(const BallModel::Vector& p)
      : m_uu(static_cast<float>(1 - 2 * p[BallModel::kStretch1])),
        m_vv(static_cast<float>(1 + 2 * p[BallModel::kStretch1])),
        m_uv(static_cast<float>(-2 * p[BallModel::kStretch2])),
        radius(static_cast<float>(p[BallModel::kRadius])),
        per_radius(1.0F / radius),
        blur(static_cast<float>(p[BallModel::kBlur])),
        per_blur(1.0F / blur),
        epsilon(blur / radius),
        shading(static_cast<float>(p[BallModel::kShading])),
        amplitude(static_cast<float>(p[BallModel::kAmplitude])) {}

  float m_uu, m_vv, m_uv;  ///< matrix of the outline
  float radius, per_radius, blur, per_blur, epsilon, shading, amplitude;
};

/// Holds a ball's light in one pixel, over the background, and its derivatives.
struct BallPixel {
  float depth;  ///< distance inside the limb in units of the blur
  float grey;   ///< [DN]
  float by_u, by_v, by_radius, by_stretch1, by_stretch2, by_blur, by_amplitude, by_shading;
};

/// Keeps the direction defined at the very centre.
constexpr float kSmallestDistance2_px2 = 1e-6F;

STEREOMOTION_INLINE float ReciprocalRoot(float x) { return 1.0F / std::sqrt(x); }

/// Evaluates a ball at (x, y) from its centre; without branches, so that loops vectorise.
STEREOMOTION_INLINE BallPixel EvaluateBallPixel(const BallOutline& o, const EdgeTable& table,
                                                float x, float y) {
  const float r2 = x * x + y * y + kSmallestDistance2_px2;
  const float m_x = o.m_uu * x + o.m_uv * y;
  const float m_y = o.m_uv * x + o.m_vv * y;
  const float s2 = m_x * x + m_y * y + kSmallestDistance2_px2;
  const float per_s = ReciprocalRoot(s2);
  const float per_r = ReciprocalRoot(r2);
  const float s = s2 * per_s;
  // (R − s) is the distance in the stretched plane; r/s turns it back into pixels.
  const float scale = r2 * per_r * per_s * o.per_blur;
  const float z = scale * (o.radius - s);
  const EdgeValue edge = table.At(z);
  const float inside = z > 0.0F ? z : 0.0F;
  const float cosine2 = o.epsilon * (2.0F * edge.height - o.epsilon * inside * inside);
  const float per_cosine = ReciprocalRoot(cosine2);
  const float cosine = cosine2 * per_cosine;
  const float shade = 1.0F - o.shading + o.shading * cosine;
  const float d_cosine_dz = o.epsilon * (edge.height_slope - o.epsilon * inside) * per_cosine;
  const float d_cosine_de = (edge.height - o.epsilon * inside * inside) * per_cosine;
  const float covered = o.amplitude * edge.coverage;
  const float dz = o.amplitude * edge.slope * shade + covered * o.shading * d_cosine_dz;
  const float de = covered * o.shading * d_cosine_de;
  const float along_s = dz * scale * o.radius * per_s * per_s;
  const float along_r = dz * (o.radius - s) * per_s * o.per_blur * per_r;
  BallPixel pixel;
  pixel.depth = z;
  pixel.grey = covered * shade;
  pixel.by_u = along_s * m_x - along_r * x;
  pixel.by_v = along_s * m_y - along_r * y;
  pixel.by_radius = dz * scale - de * o.epsilon * o.per_radius;
  pixel.by_stretch1 = along_s * (x * x - y * y);
  pixel.by_stretch2 = along_s * 2.0F * x * y;
  pixel.by_blur = -dz * z * o.per_blur + de * o.per_radius;
  pixel.by_amplitude = edge.coverage * shade;
  pixel.by_shading = covered * (cosine - 1.0F);
  return pixel;
}

}  // namespace stereomotion
