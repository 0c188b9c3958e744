#pragma once

#include <Eigen/Core>
#include <optional>

namespace stereomotion {

/// Holds a pinhole camera with Brown–Conrady distortion, OpenCV's model and order of coefficients.
///
///   x' = x (1 + k1 r² + k2 r⁴ + k3 r⁶) + 2 p1 x y + p2 (r² + 2x²),
///   y' = y (1 + k1 r² + k2 r⁴ + k3 r⁶) + p1 (r² + 2y²) + 2 p2 x y,  u = fx x' + cx,  v = fy y' +
///   cy
///
/// with (x, y) = (X/Z, Y/Z) in the camera frame (x right, y down, z forward). Valid where the
/// radial mapping is monotonic; `Project` answers nothing beyond. Pixel (0, 0) is a pixel's centre.
struct CameraModel {
  static constexpr int kNumParameters = 9;
  using Parameters = Eigen::Matrix<double, kNumParameters, 1>;

  double fx_px = 0, fy_px = 0, cx_px = 0, cy_px = 0;
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0;

  /// Distorts a normalised image point; `jacobian` receives ∂(x', y')/∂(x, y).
  Eigen::Vector2d Distort(const Eigen::Vector2d& normalized,
                          Eigen::Matrix2d* jacobian = nullptr) const;

  /// Inverts `Distort` by Newton's method to 1e-13; nothing where it does not converge.
  std::optional<Eigen::Vector2d> Undistort(const Eigen::Vector2d& distorted) const;

  /// Projects a point in the camera frame [mm] to the image [px]; nothing behind the camera (z ≤ 0)
  /// or beyond the model's valid field. `d_point` receives ∂(u, v)/∂(X, Y, Z) [px/mm],
  /// `d_parameters` ∂(u, v)/∂(fx, fy, cx, cy, k1, k2, p1, p2, k3).
  std::optional<Eigen::Vector2d> Project(
      const Eigen::Vector3d& p_in_cam_mm, Eigen::Matrix<double, 2, 3>* d_point = nullptr,
      Eigen::Matrix<double, 2, kNumParameters>* d_parameters = nullptr) const;

  /// Finds the ray (X/Z, Y/Z) of a pixel; nothing beyond the valid field.
  std::optional<Eigen::Vector2d> Unproject(const Eigen::Vector2d& pixel_px) const;

  /// Tells whether the radial mapping grows all the way out to this undistorted point. Exact, and
  /// cheap enough for every projection.
  [[nodiscard]] bool InValidField(const Eigen::Vector2d& normalized) const;

  /// Largest undistorted radius r = |(X/Z, Y/Z)| up to which the radial mapping grows.
  [[nodiscard]] double MaxNormalizedRadius() const;
};

}  // namespace stereomotion
