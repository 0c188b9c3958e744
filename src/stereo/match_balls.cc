#include "stereomotion/stereo/match_balls.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "stereomotion/camera/sphere_projection.h"
#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

/// A blob that is not a cleanly fitted ball has a centre that is only this good: its covariance, if
/// any, describes the noise and not what hides or deforms the ball.
constexpr double kRoughSigmaPx = 0.5;

Eigen::Matrix2d UsableCovariance(const BallObservation& ball) {
  const Eigen::Matrix2d& c = ball.covariance_px2;
  const bool valid = c.allFinite() && c(0, 0) > 0 && c(1, 1) > 0 && c.determinant() > 0;
  const Eigen::Matrix2d rough_px2 = kRoughSigmaPx * kRoughSigmaPx * Eigen::Matrix2d::Identity();
  if (!valid) return rough_px2;
  return ball.status == BlobStatus::kOk ? c : Eigen::Matrix2d(c + rough_px2);
}

/// Holds what the epipolar gate needs of one detection; made once, used against all of the other
/// image.
struct Sighting {
  int index;
  Eigen::Vector3d ray;   ///< undistorted (x, y, 1)
  Eigen::Vector2d line;  ///< ∂ constraint / ∂ ray of a PARTNER in the other camera (x, y part)
  double offset;         ///< the partner's constraint is line · (x, y) + offset
  Eigen::Matrix2d ray_per_px;
  Eigen::Matrix2d covariance_px2;
  double shift_bound_px;  ///< how far the outline's centre may lie from the ball's
};

/// Undistorts all detections; `partner_line_from_ray` maps a ray to the other image's epipolar
/// line.
std::vector<Sighting> Sight(const RigCamera& camera, const std::vector<BallObservation>& balls,
                            const Eigen::Matrix3d& partner_line_from_ray, bool has_radius) {
  std::vector<Sighting> sightings;
  sightings.reserve(balls.size());
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const auto ray = camera.model.Unproject(balls[i].center_px);
    if (!ray) continue;
    Eigen::Matrix2d jacobian;
    camera.model.Distort(*ray, &jacobian);
    const Eigen::Vector2d focal_px(camera.model.fx_px, camera.model.fy_px);
    const Eigen::Vector3d line = partner_line_from_ray * ray->homogeneous();
    // The ellipse's centre is off by f tan θ (radius / f)², distortion by less than that again.
    const double shift_px = 2 * ray->norm() * balls[i].semi_major_px * balls[i].semi_major_px /
                            std::min(focal_px.x(), focal_px.y());
    sightings.push_back({static_cast<int>(i), ray->homogeneous(), line.head<2>(), line.z(),
                         (focal_px.asDiagonal() * jacobian).inverse(), UsableCovariance(balls[i]),
                         has_radius ? shift_px : 0});
  }
  return sightings;
}

/// Measures a pair against the epipolar constraint c(left, right) = 0 to first order (Sampson).
struct EpipolarGap {
  double constraint;
  double gradient2;  ///< |∂c/∂(4 pixel coordinates)|² [1/px²]
  double variance;   ///< of the constraint, from the detections' covariances

  EpipolarGap(const Sighting& left, const Sighting& right) {
    constraint = left.line.dot(right.ray.head<2>()) + left.offset;
    const Eigen::Vector2d d_left = left.ray_per_px.transpose() * right.line;
    const Eigen::Vector2d d_right = right.ray_per_px.transpose() * left.line;
    gradient2 = d_left.squaredNorm() + d_right.squaredNorm();
    variance =
        d_left.dot(left.covariance_px2 * d_left) + d_right.dot(right.covariance_px2 * d_right);
  }

  /// Tells whether the distance is within the gate, or beyond it by less than `extra_px`.
  [[nodiscard]] bool Within(const MatchOptions& options, double extra_px) const {
    const double slack2 = options.rig_slack_px * options.rig_slack_px;
    return std::abs(constraint) <= options.gate_sigma * std::sqrt(variance + slack2 * gradient2) +
                                       extra_px * std::sqrt(gradient2);
  }

  /// Turns χ² under the detections' covariances into χ² with the rig's slack added.
  [[nodiscard]] double WithSlack(double chi2, const MatchOptions& options) const {
    const double slack2 = options.rig_slack_px * options.rig_slack_px;
    return chi2 * variance / (variance + slack2 * gradient2);
  }
};

/// Tells whether both cameras see about the same ball size; partly seen balls tell nothing.
bool SimilarSize(const RigCamera& left, const RigCamera& right, const BallObservation& left_ball,
                 const BallObservation& right_ball, const Eigen::Vector3d& p_in_world_mm,
                 double max_ratio) {
  const auto size_mm = [&](const RigCamera& camera, const BallObservation& ball) {
    if (ball.status == BlobStatus::kPartly || ball.status == BlobStatus::kClipped) return 0.0;
    const double focal_px = 0.5 * (camera.model.fx_px + camera.model.fy_px);
    return ball.diameter_px() / focal_px * (camera.cam_from_world * p_in_world_mm).z();
  };
  const double left_mm = size_mm(left, left_ball), right_mm = size_mm(right, right_ball);
  if (!(left_mm > 0 && right_mm > 0)) return true;
  return std::max(left_mm, right_mm) <= max_ratio * std::min(left_mm, right_mm);
}

/// Triangulates the centre of a ball of known radius from the centres of its outlines.
std::optional<TriangulatedPoint> TriangulateBall(const RigCamera& left, const RigCamera& right,
                                                 const PointPair& outlines, double radius_mm) {
  constexpr int kShiftSteps = 2;  // each shrinks the error by the shift's relative change: < 1e-3
  auto point = Triangulate(left, right, outlines);
  for (int step = 0; step < kShiftSteps && point && radius_mm > 0; ++step) {
    const Eigen::Vector3d p_in_world_mm = point->p_in_world_mm;
    const auto in_left = ProjectSphere(left.model, left.cam_from_world * p_in_world_mm, radius_mm);
    const auto in_right =
        ProjectSphere(right.model, right.cam_from_world * p_in_world_mm, radius_mm);
    if (!in_left || !in_right) return std::nullopt;
    PointPair centers = outlines;
    centers.left_px -= in_left->shift_px();
    centers.right_px -= in_right->shift_px();
    point = Triangulate(left, right, centers);
  }
  if (!point) return std::nullopt;
  return *point;
}

}  // namespace

void FindStereoCandidates(const RigCamera& left, const RigCamera& right,
                          const std::vector<BallObservation>& left_balls,
                          const std::vector<BallObservation>& right_balls, double ball_radius_mm,
                          const MatchOptions& options, std::vector<StereoCandidate>& candidates) {
  if (!(ball_radius_mm >= 0) || !(options.gate_sigma > 0) || !(options.rig_slack_px >= 0)) {
    throw std::invalid_argument("FindStereoCandidates: radius, gate or slack out of range");
  }
  candidates.clear();
  const Rigid3 right_from_left = right.cam_from_world * left.cam_from_world.Inverse();
  const Eigen::Matrix3d essential = Hat(right_from_left.translation_mm.normalized()) *
                                    right_from_left.rotation.toRotationMatrix();
  const bool has_radius = ball_radius_mm > 0;
  const auto left_sightings = Sight(left, left_balls, essential, has_radius);
  const auto right_sightings = Sight(right, right_balls, essential.transpose(), has_radius);

  for (const Sighting& l : left_sightings) {
    for (const Sighting& r : right_sightings) {
      const EpipolarGap gap(l, r);
      if (!gap.Within(options, l.shift_bound_px + r.shift_bound_px)) continue;
      const BallObservation& left_ball = left_balls[l.index];
      const BallObservation& right_ball = right_balls[r.index];
      const auto point = TriangulateBall(
          left, right,
          {left_ball.center_px, right_ball.center_px, l.covariance_px2, r.covariance_px2},
          ball_radius_mm);
      if (!point) continue;
      if (gap.WithSlack(point->chi2, options) > options.gate_sigma * options.gate_sigma) continue;
      if (!SimilarSize(left, right, left_ball, right_ball, point->p_in_world_mm,
                       options.max_size_ratio)) {
        continue;
      }
      candidates.push_back({l.index, r.index, *point});
    }
  }
}

}  // namespace stereomotion
