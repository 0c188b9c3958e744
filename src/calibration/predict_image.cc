#include "predict_image.h"

#include <array>
#include <cmath>

#include "stereomotion/camera/sphere_projection.h"

namespace stereomotion {
namespace {

// Cubature of degree 5 on the unit disc (Stroud 1971, S2: 5-1): the centre with weight 1/4, six
// points at √(2/3) with weight 1/8 each.
constexpr int kRing = 6;

}  // namespace

std::optional<Eigen::Vector2d> CircleShift(const RigCamera& camera, const Rigid3& world_from_target,
                                           const Eigen::Vector3d& center_in_target_mm,
                                           double radius_mm) {
  const Eigen::Matrix3d axes = world_from_target.rotation.toRotationMatrix();
  Eigen::Vector2d moment = Eigen::Vector2d::Zero(), center_px = Eigen::Vector2d::Zero();
  double area = 0;
  for (int i = 0; i <= kRing; ++i) {
    const double angle = 2 * M_PI * i / kRing;
    const double reach = i == kRing ? 0 : radius_mm * std::sqrt(2.0 / 3.0);
    const Eigen::Vector3d p_in_target_mm =
        center_in_target_mm + reach * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0);
    Eigen::Matrix<double, 2, 3> d_world;
    const auto pixel = ProjectWorldPoint(camera, world_from_target * p_in_target_mm, &d_world);
    if (!pixel) return std::nullopt;
    const double stretch = std::abs((d_world * axes.leftCols<2>()).determinant());
    const double weight = stretch * (i == kRing ? 0.25 : 0.125);
    moment += weight * *pixel;
    area += weight;
    if (i == kRing) center_px = *pixel;
  }
  return moment / area - center_px;
}

std::optional<PointImage> PredictImage(const RigCamera& camera, const Rigid3& world_from_target,
                                       const BundlePoint& point) {
  PointImage image;
  const Eigen::Vector3d p_in_world_mm = world_from_target * point.xyz_mm;
  const auto pixel = ProjectWorldPoint(camera, p_in_world_mm, &image.d_world, &image.d_camera);
  if (!pixel) return std::nullopt;
  image.pixel_px = *pixel;
  if (point.ball_radius_mm > 0) {
    const auto sphere =
        ProjectSphere(camera.model, camera.cam_from_world * p_in_world_mm, point.ball_radius_mm);
    if (!sphere) return std::nullopt;
    image.pixel_px += sphere->shift_px();
  } else if (point.circle_radius_mm > 0) {
    const auto shift = CircleShift(camera, world_from_target, point.xyz_mm, point.circle_radius_mm);
    if (!shift) return std::nullopt;
    image.pixel_px += *shift;
  }
  return image;
}

}  // namespace stereomotion
