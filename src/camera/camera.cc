#include "stereomotion/camera/camera.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace stereomotion {
namespace {

/// Holds the radial mapping's slope d(r')/dr = 1 + 3 k1 s + 5 k2 s² + 7 k3 s³, s = r².
struct RadialSlope {
  double k1, k2, k3;

  double operator()(double s) const { return 1 + s * (3 * k1 + s * (5 * k2 + s * 7 * k3)); }

  /// Finds the real s > 0 where the slope is stationary, ascending; returns how many.
  int StationaryPoints(std::array<double, 2>& at) const {
    // a s² + 2 h s + c = 0, in the form that does not cancel (a or h may be zero).
    const double a = 21 * k3, h = 5 * k2, c = 3 * k1;
    const double discriminant = h * h - a * c;
    if (discriminant < 0) return 0;
    const double q = -(h + std::copysign(std::sqrt(discriminant), h));
    int count = 0;
    for (const double s : {q / a, c / q}) {
      if (std::isfinite(s) && s > 0) at[count++] = s;
    }
    if (count == 2 && at[0] > at[1]) std::swap(at[0], at[1]);
    return count;
  }

  /// Tells whether the slope is positive on all of [0, s].
  bool PositiveUpTo(double s) const {
    const double at_end = (*this)(s);
    if (!(at_end > 0)) return false;
    // The cubic's Bernstein coefficients on [0, s] bound it from below: nearly every call ends
    // here.
    if (1 + k1 * s > 0 && 1 + s * (2 * k1 + s * 5 / 3 * k2) > 0) return true;
    std::array<double, 2> stationary{};
    const int count = StationaryPoints(stationary);
    return std::all_of(stationary.begin(), stationary.begin() + count,
                       [&](double at) { return at >= s || (*this)(at) > 0; });
  }

  /// Finds the smallest s > 0 with slope 0; infinity where there is none.
  double FirstRoot() const {
    std::array<double, 2> stationary{};
    const int count = StationaryPoints(stationary);
    double low = 0;
    for (int i = 0; i < count; ++i) {
      if ((*this)(stationary[i]) <= 0) return Bisect(low, stationary[i]);
      low = stationary[i];
    }
    constexpr double kBeyondAnyLens = 1e8;  // s = tan²: 0.006° from sideways
    for (double high = std::max(1.0, 2 * low); high < kBeyondAnyLens; high *= 2) {
      if ((*this)(high) <= 0) return Bisect(low, high);
    }
    return std::numeric_limits<double>::infinity();
  }

 private:
  /// Narrows a sign change (slope > 0 at `low`, ≤ 0 at `high`) down to neighbouring numbers.
  double Bisect(double low, double high) const {
    for (;;) {
      const double middle = low + (high - low) / 2;
      if (!(middle > low && middle < high)) return low;
      ((*this)(middle) > 0 ? low : high) = middle;
    }
  }
};

/// Runs Newton's method on Distort(x) = distorted from `start`; nothing where it does not converge
/// inside the valid field.
std::optional<Eigen::Vector2d> SolveUndistort(const CameraModel& camera,
                                              const Eigen::Vector2d& distorted,
                                              Eigen::Vector2d start) {
  constexpr int kMaxIterations = 30;
  constexpr double kTolerance = 1e-13;
  for (int i = 0; i < kMaxIterations; ++i) {
    Eigen::Matrix2d jacobian;
    const Eigen::Vector2d miss = distorted - camera.Distort(start, &jacobian);
    const Eigen::Vector2d step = jacobian.inverse() * miss;
    start += step;
    if (!start.allFinite()) return std::nullopt;
    if (step.norm() <= kTolerance * (1 + start.norm())) {
      return camera.InValidField(start) ? std::optional(start) : std::nullopt;
    }
  }
  return std::nullopt;
}

/// Solves the radial part alone by bisection: a start for Newton that no lens can throw off.
Eigen::Vector2d RadialStart(const CameraModel& camera, const Eigen::Vector2d& distorted) {
  const double target = distorted.norm();
  double low = 0, high = camera.MaxNormalizedRadius();
  if (!std::isfinite(high)) high = 1 + 10 * target;
  for (int i = 0; i < 40; ++i) {
    const double r = (low + high) / 2, s = r * r;
    const double mapped = r * (1 + s * (camera.k1 + s * (camera.k2 + s * camera.k3)));
    (mapped < target ? low : high) = r;
  }
  return distorted * (low / target);
}

}  // namespace

Eigen::Vector2d CameraModel::Distort(const Eigen::Vector2d& normalized,
                                     Eigen::Matrix2d* jacobian) const {
  const double x = normalized.x(), y = normalized.y(), xy = x * y;
  const double s = normalized.squaredNorm();
  const double radial = 1 + s * (k1 + s * (k2 + s * k3));
  if (jacobian != nullptr) {
    const double slope2 = 2 * (k1 + s * (2 * k2 + s * 3 * k3));  // 2 ∂radial/∂s
    const double mixed = slope2 * xy + 2 * (p1 * x + p2 * y);
    *jacobian << radial + slope2 * x * x + 2 * p1 * y + 6 * p2 * x, mixed, mixed,
        radial + slope2 * y * y + 6 * p1 * y + 2 * p2 * x;
  }
  return {x * radial + 2 * p1 * xy + p2 * (s + 2 * x * x),
          y * radial + p1 * (s + 2 * y * y) + 2 * p2 * xy};
}

std::optional<Eigen::Vector2d> CameraModel::Undistort(const Eigen::Vector2d& distorted) const {
  if (!distorted.allFinite()) return std::nullopt;
  if (auto direct = SolveUndistort(*this, distorted, distorted)) return direct;
  return SolveUndistort(*this, distorted, RadialStart(*this, distorted));
}

std::optional<Eigen::Vector2d> CameraModel::Project(
    const Eigen::Vector3d& p_in_cam_mm, Eigen::Matrix<double, 2, 3>* d_point,
    Eigen::Matrix<double, 2, kNumParameters>* d_parameters) const {
  if (!(p_in_cam_mm.z() > 0)) return std::nullopt;
  const double inverse_z = 1 / p_in_cam_mm.z();
  const Eigen::Vector2d ray = p_in_cam_mm.head<2>() * inverse_z;
  if (!InValidField(ray)) return std::nullopt;

  Eigen::Matrix2d d_ray;
  const Eigen::Vector2d distorted = Distort(ray, d_point != nullptr ? &d_ray : nullptr);
  const Eigen::Vector2d focal_px(fx_px, fy_px);
  if (d_point != nullptr) {
    d_ray = (focal_px * inverse_z).asDiagonal() * d_ray;
    d_point->leftCols<2>() = d_ray;
    d_point->col(2) = -d_ray * ray;
  }
  if (d_parameters != nullptr) {
    const double x = ray.x(), y = ray.y(), s = ray.squaredNorm();
    // clang-format off
    *d_parameters << distorted.x(), 0, 1, 0, fx_px * x * s, fx_px * x * s * s,
                     fx_px * 2 * x * y, fx_px * (s + 2 * x * x), fx_px * x * s * s * s,
                     0, distorted.y(), 0, 1, fy_px * y * s, fy_px * y * s * s,
                     fy_px * (s + 2 * y * y), fy_px * 2 * x * y, fy_px * y * s * s * s;
    // clang-format on
  }
  return Eigen::Vector2d(focal_px.cwiseProduct(distorted) + Eigen::Vector2d(cx_px, cy_px));
}

std::optional<Eigen::Vector2d> CameraModel::Unproject(const Eigen::Vector2d& pixel_px) const {
  return Undistort({(pixel_px.x() - cx_px) / fx_px, (pixel_px.y() - cy_px) / fy_px});
}

bool CameraModel::InValidField(const Eigen::Vector2d& normalized) const {
  return RadialSlope{k1, k2, k3}.PositiveUpTo(normalized.squaredNorm());
}

double CameraModel::MaxNormalizedRadius() const {
  return std::sqrt(RadialSlope{k1, k2, k3}.FirstRoot());
}

}  // namespace stereomotion
