#include "bench/exposure_bound.h"

#include <Eigen/LU>
#include <cmath>

#include "bench/accuracy_bound.h"
#include "stereomotion/camera/sphere_projection.h"
#include "stereomotion/geometry/rigid3.h"

namespace stereomotion::bench {
namespace {

/// Image of a ball in the middle of the body, as a camera sees it; smeared by the motion.
BallScene BallInImage(const Scenario& scene, const RigCamera& camera, double diameter_px) {
  const double full_dn = scene.sensor.full_scale_dn();
  const double ball_dn = scene.light.ball_level * full_dn;
  const Eigen::Vector3d path_mm = scene.motion.velocity_in_world_mm_s * scene.sensor.exposure_s;
  BallScene ball;
  ball.background_dn = scene.light.background_level * full_dn;
  ball.blur_px = scene.light.blur_px;
  ball.ball = RoundBall(Eigen::Vector2d::Zero(), diameter_px, ball_dn - ball.background_dn);
  ball.ball.shading = scene.light.limb_falloff * ball_dn / ball.ball.amplitude_dn;
  ball.ball.smear_px =
      *ProjectWorldPoint(camera, path_mm / 2) - *ProjectWorldPoint(camera, -path_mm / 2);
  return ball;
}

/// Mean bound over some places within the pixel.
Eigen::Matrix2d MeanCenterBound(BallScene ball, const SensorNoise& noise) {
  constexpr int kPlaces = 2;  // an axis
  Eigen::Matrix2d sum_px2 = Eigen::Matrix2d::Zero();
  for (int i = 0; i < kPlaces * kPlaces; ++i) {
    const Eigen::Vector2d place(i % kPlaces, i / kPlaces);
    ball.ball.center_px = (place.array() + 0.5).matrix() / kPlaces;
    sum_px2 += CenterBound(ball, noise);
  }
  return sum_px2 / (kPlaces * kPlaces);
}

/// ∂ (centre of a ball's outline) / ∂ (δθ, δt) of the body's pose.
Eigen::Matrix<double, 2, 6> OutlineJacobian(const RigCamera& camera, const Rigid3& world_from_body,
                                            const Eigen::Vector3d& p_in_body_mm, double radius_mm) {
  const auto center_px = [&](const Vector6d& delta) {
    const Rigid3 pose = Perturb(world_from_body, delta);
    return ProjectSphere(camera.model, camera.cam_from_world * (pose * p_in_body_mm), radius_mm)
        .value()
        .outline.center_px;
  };
  Eigen::Matrix<double, 2, 6> jacobian;
  for (int k = 0; k < 6; ++k) {
    const double step = k < 3 ? 1e-5 : 1e-2;  // [rad], [mm]
    const Vector6d delta = step * Vector6d::Unit(k);
    jacobian.col(k) = (center_px(delta) - center_px(-delta)) / (2 * step);
  }
  return jacobian;
}

}  // namespace

double TranslationBound_mm(const ExposureCondition& condition) {
  const Scenario scene = MakeExposureScene(condition);
  const Rigid3 world_from_body = StateAt(scene.motion, 0).world_from_body;
  Matrix6d fisher = Matrix6d::Zero();
  for (const RigCamera& camera : scene.rig.cameras) {
    const double radius_mm = scene.body.rods.front().ball_diameter_mm / 2;
    const auto middle = ProjectSphere(
        camera.model, camera.cam_from_world * Eigen::Vector3d::Zero().eval(), radius_mm);
    const ImageEllipse& outline = middle.value().outline;
    const BallScene ball =
        BallInImage(scene, camera, outline.semi_major_px + outline.semi_minor_px);
    const Eigen::Matrix2d weight = MeanCenterBound(ball, scene.sensor.noise()).inverse();
    for (const Rod& rod : scene.body.rods) {
      for (const Eigen::Vector3d& p_in_body_mm : rod.balls_in_body_mm) {
        const auto jacobian = OutlineJacobian(camera, world_from_body, p_in_body_mm, radius_mm);
        fisher += jacobian.transpose() * weight * jacobian;
      }
    }
  }
  const Matrix6d covariance = fisher.inverse();
  const Eigen::Vector3d direction = MotionDirection();
  return std::sqrt(2 * direction.dot(covariance.bottomRightCorner<3, 3>() * direction));
}

}  // namespace stereomotion::bench
