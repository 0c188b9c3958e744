#include "stereomotion/camera/sphere_projection.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace stereomotion {
namespace {

/// Holds an ellipse in the undistorted normalised image: centre and semi-axes as vectors.
struct NormalizedEllipse {
  Eigen::Vector2d center;
  Eigen::Vector2d major;
  Eigen::Vector2d minor;
  double max_radius;  ///< of its points, from the principal point
};

/// Cuts the cone that touches the sphere with the plane Z = 1.
///
/// With c = (q, Z), w = Z² − r²: centre Z q / w; semi-axes r √(w + |q|²) / w along q and r / √w
/// across it. All derived from the conic c cᵀ − (cᵀc − r²) I.
NormalizedEllipse CutCone(const Eigen::Vector3d& c_mm, double r_mm) {
  const Eigen::Vector2d q_mm = c_mm.head<2>();
  const double q_norm_mm = q_mm.norm();
  const double w_mm2 = c_mm.z() * c_mm.z() - r_mm * r_mm;
  const Eigen::Vector2d outward =
      q_norm_mm > 0 ? Eigen::Vector2d(q_mm / q_norm_mm) : Eigen::Vector2d(1, 0);
  const double major = r_mm * std::sqrt(w_mm2 + q_norm_mm * q_norm_mm) / w_mm2;
  const double minor = r_mm / std::sqrt(w_mm2);
  const double center = c_mm.z() * q_norm_mm / w_mm2;
  return {center * outward, major * outward, minor * Eigen::Vector2d(-outward.y(), outward.x()),
          center + major};
}

/// Holds the centroid and the second central moments of an area.
struct AreaMoments {
  Eigen::Vector2d centroid;
  Eigen::Matrix2d moments;
};

/// Integrates over the distorted image of the ellipse: ∫ g(f) |J| over the undistorted one, by the
/// seven-point rule for the disc that is exact to fifth order (Stroud 1971, S2: 5-1). What is left
/// out is of sixth order in the ellipse's size.
AreaMoments DistortEllipse(const CameraModel& camera, const NormalizedEllipse& ellipse) {
  constexpr double kCenterWeight = 1.0 / 4, kRingWeight = 1.0 / 8;
  const double ring_radius = std::sqrt(2.0 / 3);
  Eigen::Matrix2d jacobian;
  const Eigen::Vector2d middle = camera.Distort(ellipse.center, &jacobian);
  double area = kCenterWeight * jacobian.determinant();
  // Sums run over deviations from the middle, or small balls would lose their digits.
  Eigen::Vector2d first = Eigen::Vector2d::Zero();
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  for (const double side : {-ring_radius, ring_radius}) {
    const double along = side / 2, across = side * std::sqrt(3.0) / 2;
    for (const Eigen::Vector2d& offset :
         {Eigen::Vector2d(side * ellipse.major),
          Eigen::Vector2d(along * ellipse.major + across * ellipse.minor),
          Eigen::Vector2d(along * ellipse.major - across * ellipse.minor)}) {
      const Eigen::Vector2d deviation = camera.Distort(ellipse.center + offset, &jacobian) - middle;
      const double weight = kRingWeight * jacobian.determinant();
      area += weight;
      first += weight * deviation;
      second += weight * deviation * deviation.transpose();
    }
  }
  first /= area;
  return {middle + first, second / area - first * first.transpose()};
}

/// Turns area moments [px²] into the ellipse that has them.
ImageEllipse EllipseFromMoments(const Eigen::Vector2d& center_px, const Eigen::Matrix2d& moments) {
  const double mean = (moments(0, 0) + moments(1, 1)) / 2;
  const double half_difference = (moments(0, 0) - moments(1, 1)) / 2;
  const double spread = std::hypot(half_difference, moments(0, 1));
  ImageEllipse ellipse;
  ellipse.center_px = center_px;
  ellipse.semi_major_px = 2 * std::sqrt(mean + spread);
  ellipse.semi_minor_px = 2 * std::sqrt(std::max(0.0, mean - spread));
  // + 0.0 turns −0 into 0: an upright ellipse has +π/2, never −π/2.
  ellipse.angle_rad = 0.5 * std::atan2(moments(0, 1) + 0.0, half_difference);
  return ellipse;
}

}  // namespace

std::optional<SphereProjection> ProjectSphere(const CameraModel& camera,
                                              const Eigen::Vector3d& center_in_cam_mm,
                                              double radius_mm) {
  if (!(radius_mm >= 0)) throw std::invalid_argument("ProjectSphere: the radius must be ≥ 0 mm");
  if (!(center_in_cam_mm.z() > radius_mm)) return std::nullopt;
  const auto center_px = camera.Project(center_in_cam_mm);
  const NormalizedEllipse ellipse = CutCone(center_in_cam_mm, radius_mm);
  // Only the radius matters for the valid field: ask for the outline's farthest point.
  if (!center_px || !camera.InValidField({ellipse.max_radius, 0})) return std::nullopt;

  const AreaMoments distorted = DistortEllipse(camera, ellipse);
  const Eigen::Vector2d focal_px(camera.fx_px, camera.fy_px);
  SphereProjection projection;
  projection.center_px = *center_px;
  projection.outline = EllipseFromMoments(
      focal_px.cwiseProduct(distorted.centroid) + Eigen::Vector2d(camera.cx_px, camera.cy_px),
      focal_px.asDiagonal() * distorted.moments * focal_px.asDiagonal());
  return projection;
}

}  // namespace stereomotion
