#include "stereomotion/stereo/triangulate.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace stereomotion {
namespace {

using Failure = TriangulationFailure;

constexpr int kMaxIterations = 20;
/// A step shorter than this share of the distance ends the iteration; Gauss–Newton's next one would
/// be smaller by several orders.
constexpr double kRelativeStep = 1e-10;

Eigen::Matrix2d Weight(const Eigen::Matrix2d& covariance_px2) {
  const bool positive = covariance_px2(0, 0) > 0 && covariance_px2(1, 1) > 0 &&
                        covariance_px2.determinant() > 0 && covariance_px2.allFinite();
  if (!positive) throw std::invalid_argument("Triangulate: a covariance is not positive definite");
  return covariance_px2.inverse();
}

/// Holds a line of sight in world coordinates.
struct Sight {
  Eigen::Vector3d origin_in_world_mm;
  Eigen::Vector3d direction_in_world;  ///< unit
};

std::optional<Sight> LineOfSight(const RigCamera& camera, const Eigen::Vector2d& pixel_px) {
  const auto ray = camera.model.Unproject(pixel_px);
  if (!ray) return std::nullopt;
  const Rigid3 world_from_cam = camera.cam_from_world.Inverse();
  return Sight{world_from_cam.translation_mm,
               (world_from_cam.rotation * ray->homogeneous()).normalized()};
}

/// Finds the point halfway between the lines of sight where they are nearest to each other.
Expected<Eigen::Vector3d, Failure> Midpoint(const Sight& left, const Sight& right,
                                            double min_ray_angle_rad) {
  const Eigen::Vector3d normal = left.direction_in_world.cross(right.direction_in_world);
  const double cosine = left.direction_in_world.dot(right.direction_in_world);
  // Opposite rays (angle near π) leave the depth as open as parallel ones.
  if (std::atan2(normal.norm(), std::abs(cosine)) < min_ray_angle_rad) {
    return Unexpected{Failure::kRaysNearlyParallel};
  }
  const Eigen::Vector3d between_mm = right.origin_in_world_mm - left.origin_in_world_mm;
  const double left_mm = between_mm.cross(right.direction_in_world).dot(normal);
  const double right_mm = between_mm.cross(left.direction_in_world).dot(normal);
  if (!(left_mm > 0 && right_mm > 0)) return Unexpected{Failure::kBehindCamera};
  return Eigen::Vector3d(
      0.5 * (left.origin_in_world_mm + right.origin_in_world_mm +
             (left_mm * left.direction_in_world + right_mm * right.direction_in_world) /
                 normal.squaredNorm()));
}

/// Holds the whitened least-squares problem at one point.
struct NormalEquations {
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  double chi2 = 0;

  bool Add(const RigCamera& camera, const Eigen::Vector2d& pixel_px, const Eigen::Matrix2d& weight,
           const Eigen::Vector3d& p_in_world_mm) {
    Eigen::Matrix<double, 2, 3> jacobian;
    const auto predicted_px = ProjectWorldPoint(camera, p_in_world_mm, &jacobian);
    if (!predicted_px) return false;
    const Eigen::Vector2d residual_px = pixel_px - *predicted_px;
    const Eigen::Matrix<double, 3, 2> weighted = jacobian.transpose() * weight;
    hessian += weighted * jacobian;
    gradient += weighted * residual_px;
    chi2 += residual_px.dot(weight * residual_px);
    return true;
  }
};

/// One camera's block of ∂ point / ∂ rig = −H⁻¹ JᵀW ∂h/∂c: the point gives way so that the weighted
/// residuals stay balanced (implicit function theorem, to first order in the residuals).
Eigen::Matrix<double, 3, RigParameter::kPerCamera> PointPerParameter(
    const RigCamera& camera, const Eigen::Matrix2d& weight, const TriangulatedPoint& point) {
  Eigen::Matrix<double, 2, 3> d_point;
  Eigen::Matrix<double, 2, RigParameter::kPerCamera> d_parameters;
  ProjectWorldPoint(camera, point.p_in_world_mm, &d_point, &d_parameters);
  const Eigen::Matrix<double, 3, 2> gain = point.covariance_mm2 * d_point.transpose() * weight;
  return -gain * d_parameters;
}

}  // namespace

Expected<TriangulatedPoint, TriangulationFailure> Triangulate(const RigCamera& left,
                                                              const RigCamera& right,
                                                              const PointPair& points,
                                                              const TriangulateOptions& options) {
  const Eigen::Matrix2d left_weight = Weight(points.left_cov_px2);
  const Eigen::Matrix2d right_weight = Weight(points.right_cov_px2);
  const auto left_sight = LineOfSight(left, points.left_px);
  const auto right_sight = LineOfSight(right, points.right_px);
  if (!left_sight || !right_sight) return Unexpected{Failure::kNoConvergence};
  const auto start = Midpoint(*left_sight, *right_sight, options.min_ray_angle_rad);
  if (!start) return Unexpected{start.error()};

  TriangulatedPoint point;
  point.p_in_world_mm = *start;
  const double range_mm = (*start - left_sight->origin_in_world_mm).norm();
  for (int i = 0; i < kMaxIterations; ++i) {
    NormalEquations normal;
    if (!normal.Add(left, points.left_px, left_weight, point.p_in_world_mm) ||
        !normal.Add(right, points.right_px, right_weight, point.p_in_world_mm)) {
      return Unexpected{Failure::kNoConvergence};
    }
    const Eigen::LDLT<Eigen::Matrix3d> factor(normal.hessian);
    const Eigen::Vector3d step_mm = factor.solve(normal.gradient);
    if (step_mm.norm() <= kRelativeStep * range_mm) {
      if (normal.chi2 > options.max_chi2) return Unexpected{Failure::kInconsistent};
      point.covariance_mm2 = factor.solve(Eigen::Matrix3d::Identity());
      point.chi2 = normal.chi2;
      point.d_rig << PointPerParameter(left, left_weight, point),
          PointPerParameter(right, right_weight, point);
      return point;
    }
    point.p_in_world_mm += step_mm;
  }
  return Unexpected{Failure::kNoConvergence};
}

}  // namespace stereomotion
