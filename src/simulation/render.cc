#include "stereomotion/simulation/render.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "light_patch.h"

namespace stereomotion {
namespace {

void CheckBall(const BallImage& ball) {
  const bool sane = ball.semi_minor_px > 0 && ball.semi_major_px >= ball.semi_minor_px &&
                    ball.semi_major_px < 1e4 && ball.center_px.allFinite() &&
                    ball.center_px.cwiseAbs().maxCoeff() < 1e6 && ball.smear_px.allFinite() &&
                    ball.smear_px.norm() < 1e4;
  if (!sane) {
    throw std::invalid_argument("RenderBalls: a ball needs 0 < semi_minor_px <= semi_major_px");
  }
}

void CheckOptions(const RenderOptions& options) {
  if (options.width_px <= 0 || options.height_px <= 0) {
    throw std::invalid_argument("RenderBalls: the image size must be positive");
  }
  if (!(options.blur_px >= 0) || options.blur_px > 100 || options.supersampling < 1) {
    throw std::invalid_argument("RenderBalls: blur_px in 0 … 100 and supersampling >= 1 expected");
  }
}

void AddBall(const BallImage& ball, const RenderOptions& options, MeanImage& mean_dn) {
  const Eigen::Vector2d reach_px =
      Eigen::Vector2d::Constant(ball.semi_major_px) + ball.smear_px.cwiseAbs() / 2;
  LightPatch patch(ball.center_px - reach_px, ball.center_px + reach_px, options.supersampling);
  // Midpoint rule over the path: steps of 0.1 px leave less than 0.001 px² of variance unmodelled.
  const int steps = std::max(1, static_cast<int>(std::ceil(ball.smear_px.norm() / 0.1)));
  const double c = std::cos(ball.angle_rad), s = std::sin(ball.angle_rad);
  for (int step = 0; step < steps; ++step) {
    const Eigen::Vector2d center_px = ball.center_px + ((step + 0.5) / steps - 0.5) * ball.smear_px;
    const auto rho = [&](const Eigen::Vector2d& point_px) {
      const Eigen::Vector2d d = point_px - center_px;
      return std::hypot((c * d.x() + s * d.y()) / ball.semi_major_px,
                        (c * d.y() - s * d.x()) / ball.semi_minor_px);
    };
    const auto light = [&](const Eigen::Vector2d&, double rho_here) {
      const double falloff = 1 - ball.shading * (1 - std::sqrt(1 - rho_here * rho_here));
      return ball.amplitude_dn * falloff / steps;
    };
    patch.AddDisc(ball.semi_minor_px, rho, light);
  }
  patch.AddTo(options.blur_px, mean_dn);
}

}  // namespace

void RenderMean(const std::vector<BallImage>& balls, const RenderOptions& options,
                MeanImage& mean_dn) {
  CheckOptions(options);
  for (const BallImage& ball : balls) CheckBall(ball);
  mean_dn.resize(options.height_px, options.width_px);
  for (int v = 0; v < options.height_px; ++v) {
    for (int u = 0; u < options.width_px; ++u) {
      const Eigen::Vector2d from_middle_px(u - (options.width_px - 1) / 2.0,
                                           v - (options.height_px - 1) / 2.0);
      mean_dn(v, u) = options.background_dn + options.background_slope_dn_px.dot(from_middle_px);
    }
  }
  for (const BallImage& ball : balls) AddBall(ball, options, mean_dn);
}

void RenderBalls(const std::vector<BallImage>& balls, const RenderOptions& options, Image& image) {
  MeanImage mean_dn;
  RenderMean(balls, options, mean_dn);
  SensorOptions sensor;
  sensor.noise = options.noise;
  sensor.bits = options.bits;
  sensor.seed = options.seed;
  Expose(mean_dn, sensor, image);
}

}  // namespace stereomotion
