#include "start_ball.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "multiversion.h"
#include "normal_distribution.h"
#include "pixel_variance.h"

namespace stereomotion {
namespace {

using P = BallModel;

constexpr double kUsualShading = 0.15;
/// Light and second moment of a ball of that shading, against A R² π and R².
constexpr double kLightShare = 1 - kUsualShading / 3;
constexpr double kMomentShare = ((1 - kUsualShading) / 4 + kUsualShading * 2 / 15) / kLightShare;
/// The moments' radius is trusted this far from the half-height area's.
constexpr double kRadiusTrust = 1.35;
/// Second moments that differ by this share of the smaller one show a smear of half a diameter;
/// they must differ by so many of their own standard deviations.
constexpr double kLongish = 0.3;
constexpr double kLongish_sigma = 2.5;

struct Moments {
  float light = 0, u = 0, v = 0, uu = 0, uv = 0, vv = 0;
};

STEREOMOTION_MULTIVERSION
Moments SumMoments(int size, float background, const float* __restrict u, const float* __restrict v,
                   const float* __restrict grey) {
  float light = 0, m_u = 0, m_v = 0, m_uu = 0, m_uv = 0, m_vv = 0;
#pragma omp simd reduction(+ : light, m_u, m_v, m_uu, m_uv, m_vv)
  for (int i = 0; i < size; ++i) {
    const float over = grey[i] - background;
    const float over_u = over * u[i];
    const float over_v = over * v[i];
    light += over;
    m_u += over_u;
    m_v += over_v;
    m_uu += over_u * u[i];
    m_uv += over_u * v[i];
    m_vv += over_v * v[i];
  }
  return {light, m_u, m_v, m_uu, m_uv, m_vv};
}

double BackgroundOf(const BallPatch& patch, const Blob& blob) {
  constexpr double kEnough = 30;
  return patch.ring.n >= kEnough ? patch.ring.grey / patch.ring.n : blob.background_dn;
}

/// Starts from the blob's area where the moments say nothing.
BallModel FromArea(const Blob& blob, const Eigen::Vector2d& origin_px) {
  BallModel ball;
  ball.values[P::kU] = blob.sum_u / blob.area_px - origin_px.x();
  ball.values[P::kV] = blob.sum_v / blob.area_px - origin_px.y();
  ball.values[P::kRadius] = std::max(std::sqrt(blob.area_px / kPi), 0.8);
  ball.values[P::kAmplitude] = 0.95 * (blob.peak_dn - blob.background_dn);
  ball.values[P::kShading] = kUsualShading;
  return ball;
}

/// Finds the smear of a longish ball; zero: none is evident.
Eigen::Vector2d SmearOf(const Eigen::Vector2d& moments, const Eigen::Vector2d& direction,
                        double sigma_px2) {
  const double excess = moments[1] - moments[0];
  if (!(excess > std::max(kLongish * moments[0], kLongish_sigma * sigma_px2))) {
    return Eigen::Vector2d::Zero();
  }
  return std::sqrt(12 * excess) * direction;
}

/// Standard deviation of the difference of two second moments over a disc of `area_px` pixels: the
/// sum of (x² − y²)² over it is area³ / 6π².
double MomentSigma(double light_dn, double noise_dn, double area_px) {
  return noise_dn / light_dn * std::sqrt(area_px * area_px * area_px / (6 * kPi * kPi));
}

void UseMoments(const Moments& m, double blur_px, double noise_dn, int area_px, BallModel& ball) {
  auto& p = ball.values;
  const Eigen::Vector2d mean(m.u / m.light, m.v / m.light);
  const double reach_px = 0.5 * p[P::kRadius];
  if (!((mean - p.head<2>()).cwiseAbs().maxCoeff() < reach_px)) return;
  Eigen::Matrix2d second;
  second(0, 0) = m.uu / m.light - mean.x() * mean.x();
  second(1, 1) = m.vv / m.light - mean.y() * mean.y();
  second(0, 1) = second(1, 0) = m.uv / m.light - mean.x() * mean.y();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen;
  eigen.computeDirect(second);
  p.head<2>() = mean;
  ball.smear_px = SmearOf(eigen.eigenvalues(), eigen.eigenvectors().col(1),
                          MomentSigma(m.light, noise_dn, area_px));
  const double moment_px2 = ball.smear_px.isZero() ? second.trace() / 2 : eigen.eigenvalues()[0];
  const double radius2_px2 = (moment_px2 - blur_px * blur_px) / kMomentShare;
  const double area_radius = p[P::kRadius];
  const double radius = std::sqrt(std::max(radius2_px2, 0.0));
  p[P::kRadius] = std::clamp(radius, area_radius / kRadiusTrust, area_radius * kRadiusTrust);
  p[P::kAmplitude] = m.light / (kPi * kLightShare * p[P::kRadius] * p[P::kRadius]);
}

}  // namespace

BallModel StartBall(const BallPatch& patch, const Blob& blob, const Eigen::Vector2d& origin_px,
                    const BallObservation* expected) {
  BallModel ball = FromArea(blob, origin_px);
  const double background_dn = BackgroundOf(patch, blob);
  ball.values[P::kBlur] = kUsualBlur_px;
  if (expected != nullptr && expected->blur_px > 0) {
    ball.values[P::kBlur] = std::sqrt(expected->blur_px * expected->blur_px + kPixelVariance_px2);
  }
  ball.values[P::kLevel] = background_dn;
  const Moments moments = SumMoments(patch.size, static_cast<float>(background_dn), patch.u.data(),
                                     patch.v.data(), patch.grey.data());
  if (moments.light > 0) {
    UseMoments(moments, ball.values[P::kBlur], blob.noise_dn, patch.size, ball);
  }
  if (expected != nullptr && ball.smear_px.isZero()) ball.smear_px = expected->smear_px;
  return ball;
}

const BallObservation* ExpectedAt(const std::vector<SearchWindow>& windows, double u, double v) {
  const BallObservation* nearest = nullptr;
  const auto distance_px = [&](const BallObservation& ball) {
    return (ball.center_px - Eigen::Vector2d(u, v)).norm();
  };
  for (const SearchWindow& window : windows) {
    if (u < window.u_min || u > window.u_max || v < window.v_min || v > window.v_max) continue;
    if (nearest == nullptr || distance_px(window.expected) < distance_px(*nearest)) {
      nearest = &window.expected;
    }
  }
  return nearest;
}

}  // namespace stereomotion
