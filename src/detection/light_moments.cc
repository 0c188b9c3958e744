#include "light_moments.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "multiversion.h"

namespace stereomotion {
namespace {

/// Rows are filled up to whole vectors of numbers.
constexpr int kVector = 8;

/// Sums over one row. x counts from the window's middle; the disc's soft weights are w.
struct RowSums {
  float w = 0, wx = 0, wxx = 0;   ///< disc
  float g = 0, gx = 0;            ///< disc: w × grey value
  float s = 0, sx = 0, sxx = 0;   ///< disc: w² × variance
  float r = 0, rx = 0, rxx = 0;   ///< ring
  float rg = 0, rgx = 0, rs = 0;  ///< ring: grey value, variance
};

STEREOMOTION_MULTIVERSION
RowSums SumRow(const float* __restrict grey, const float* __restrict variance,
               const float* __restrict used, int count, float x_begin, float y, float radius,
               float outer) {
  float w0 = 0, w1 = 0, w2 = 0, g0 = 0, g1 = 0, s0 = 0, s1 = 0, s2 = 0;
  float r0 = 0, r1 = 0, r2 = 0, rg0 = 0, rg1 = 0, rs0 = 0;
  const float yy = y * y;
#pragma omp simd reduction(+ : w0, w1, w2, g0, g1, s0, s1, s2, r0, r1, r2, rg0, rg1, rs0)
  for (int i = 0; i < count; ++i) {
    const float x = x_begin + static_cast<float>(i);
    const float distance = std::sqrt(x * x + yy);
    const float w = used[i] * std::min(std::max(radius + 0.5F - distance, 0.0F), 1.0F);
    const float inside = std::min(std::max(outer - distance, 0.0F), 1.0F);
    const float r = distance > radius + 0.5F ? used[i] * inside : 0.0F;
    w0 += w;
    w1 += w * x;
    w2 += w * x * x;
    g0 += w * grey[i];
    g1 += w * grey[i] * x;
    s0 += w * w * variance[i];
    s1 += w * w * variance[i] * x;
    s2 += w * w * variance[i] * x * x;
    r0 += r;
    r1 += r * x;
    r2 += r * x * x;
    rg0 += r * grey[i];
    rg1 += r * grey[i] * x;
    rs0 += r * variance[i];
  }
  return {w0, w1, w2, g0, g1, s0, s1, s2, r0, r1, r2, rg0, rg1, rs0};
}

/// Sums of 1, x, y and their products over a window.
struct Sums {
  Eigen::Matrix3d disc = Eigen::Matrix3d::Zero();      ///< Σ w q qᵀ, q = (1, x, y)
  Eigen::Vector3d light = Eigen::Vector3d::Zero();     ///< Σ w grey q
  Eigen::Matrix3d variance = Eigen::Matrix3d::Zero();  ///< Σ w² variance q qᵀ
  Eigen::Matrix3d ring = Eigen::Matrix3d::Zero();
  Eigen::Vector3d ring_light = Eigen::Vector3d::Zero();
  double ring_variance = 0;  ///< Σ variance
};

void AddProducts(double s, double sx, double sxx, double y, Eigen::Matrix3d& sum) {
  sum(0, 0) += s;
  sum(0, 1) += sx;
  sum(1, 1) += sxx;
  sum(0, 2) += s * y;
  sum(1, 2) += sx * y;
  sum(2, 2) += s * y * y;
}

void Add(const RowSums& row, double y, Sums& sums) {
  AddProducts(row.w, row.wx, row.wxx, y, sums.disc);
  AddProducts(row.s, row.sx, row.sxx, y, sums.variance);
  AddProducts(row.r, row.rx, row.rxx, y, sums.ring);
  sums.light += Eigen::Vector3d(row.g, row.gx, row.g * y);
  sums.ring_light += Eigen::Vector3d(row.rg, row.rgx, row.rg * y);
  sums.ring_variance += row.rs;
}

/// The centroid of the light over the plane through the ring, and its covariance.
LightMoments Solve(const Sums& sums, double base_dn) {
  constexpr double kFewestRingPixels = 8;  // a plane has three unknowns
  LightMoments moments;
  if (sums.ring(0, 0) < kFewestRingPixels) return moments;
  const Eigen::Matrix3d ring = sums.ring.selfadjointView<Eigen::Upper>();
  const Eigen::Matrix3d disc = sums.disc.selfadjointView<Eigen::Upper>();
  const Eigen::Matrix3d variance = sums.variance.selfadjointView<Eigen::Upper>();
  const Eigen::Matrix3d inverse = ring.inverse();
  const Eigen::Vector3d plane = inverse * sums.ring_light;
  const Eigen::Vector3d light = sums.light - disc * plane;
  if (!(light[0] > 0)) return moments;
  const Eigen::Vector2d shift = light.tail<2>() / light[0];
  // d shift / d pixel = w (x − shift) / light, and through the plane −Σ w (x − shift) q / light.
  Eigen::Matrix<double, 2, 3> lever;
  lever.col(0) = -shift;
  lever.rightCols<2>().setIdentity();
  const double ring_noise = sums.ring_variance / sums.ring(0, 0);
  const Eigen::Matrix3d both = variance + ring_noise * disc * inverse * disc;
  moments.center_px = shift;
  moments.covariance_px2 = lever * both * lever.transpose() / (light[0] * light[0]);
  moments.light_dn = light[0];
  moments.level_dn = base_dn + plane[0];
  moments.is_valid = moments.covariance_px2.allFinite();
  return moments;
}

template <class T>
void CopyRow(const T* pixels, int count, float base_dn, const SensorNoise& noise, float* grey,
             float* variance) {
  const auto saturation = static_cast<float>(noise.saturation_dn);
  const auto dark = static_cast<float>(noise.VarianceDn2(noise.black_dn));
  const auto per_dn = static_cast<float>(1 / noise.gain_e_per_dn);
  const auto black = static_cast<float>(noise.black_dn);
  for (int i = 0; i < count; ++i) {
    const auto value = static_cast<float>(pixels[i]);
    grey[i] = value - base_dn;
    // A saturated pixel has no noise left.
    variance[i] = value < saturation ? dark + per_dn * std::max(value - black, 0.0F) : 0.0F;
  }
}

}  // namespace

void LightSummer::SetBox(const ImageView& image, const LightWindow& window) {
  const double reach = window.radius_px + window.ring_px;
  u_min_ = std::max(static_cast<int>(std::floor(window.center_px.x() - reach)), 0);
  v_min_ = std::max(static_cast<int>(std::floor(window.center_px.y() - reach)), 0);
  u_max_ = std::min(static_cast<int>(std::ceil(window.center_px.x() + reach)), image.width_px - 1);
  v_max_ = std::min(static_cast<int>(std::ceil(window.center_px.y() + reach)), image.height_px - 1);
  const int width = std::max(u_max_ - u_min_ + 1, 0);
  stride_ = (width + kVector - 1) / kVector * kVector;
  grey_.assign(static_cast<std::size_t>(stride_), 0);
  variance_.assign(static_cast<std::size_t>(stride_), 0);
  used_.assign(static_cast<std::size_t>(stride_ * std::max(v_max_ - v_min_ + 1, 0)), 1);
  for (int v = v_min_; v <= v_max_; ++v) {
    std::fill_n(used_.begin() + (v - v_min_) * stride_ + width, stride_ - width, 0.0F);
  }
}

bool LightSummer::LeaveOut(int v, int u_begin, int u_end, const LightWindow& window) {
  if (v < v_min_ || v > v_max_) return false;
  const double y = v - window.center_px.y();
  bool in_disc = false;
  for (int u = std::max(u_begin, u_min_); u < std::min(u_end, u_max_ + 1); ++u) {
    used_[static_cast<std::size_t>((v - v_min_) * stride_ + u - u_min_)] = 0;
    in_disc |= std::hypot(u - window.center_px.x(), y) < window.radius_px + 0.5;
  }
  return in_disc;
}

LightMoments LightSummer::Sum(const ImageView& image, const LightWindow& window,
                              const SensorNoise& noise, double base_dn) {
  const int width = u_max_ - u_min_ + 1;
  const auto base = static_cast<float>(base_dn);
  Sums sums;
  for (int v = v_min_; v <= v_max_; ++v) {
    if (image.type == PixelType::kGray8) {
      CopyRow(image.Row<std::uint8_t>(v) + u_min_, width, base, noise, grey_.data(),
              variance_.data());
    } else {
      CopyRow(image.Row<std::uint16_t>(v) + u_min_, width, base, noise, grey_.data(),
              variance_.data());
    }
    const double y = v - window.center_px.y();
    Add(SumRow(grey_.data(), variance_.data(), used_.data() + (v - v_min_) * stride_, stride_,
               static_cast<float>(u_min_ - window.center_px.x()), static_cast<float>(y),
               static_cast<float>(window.radius_px),
               static_cast<float>(window.radius_px + window.ring_px)),
        y, sums);
  }
  LightMoments moments = Solve(sums, base_dn);
  moments.center_px += window.center_px;
  return moments;
}

}  // namespace stereomotion
