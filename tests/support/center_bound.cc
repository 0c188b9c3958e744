#include "tests/support/center_bound.h"

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <functional>

#include "stereomotion/camera/sphere_projection.h"
#include "stereomotion/simulation/render.h"

namespace stereomotion::testing {
namespace {

/// The scene of one ball as eight numbers: u, v, diameter, amplitude, background, its slopes, blur.
constexpr int kUnknowns = 8;
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;
constexpr int kSizePx = 33;

MeanImage RenderOne(const Unknowns& x, double limb_falloff) {
  RenderOptions options;
  options.width_px = options.height_px = kSizePx;
  options.background_dn = x[4];
  options.background_slope_dn_px = x.segment<2>(5);
  options.blur_px = x[7];
  BallImage ball = RoundBall(x.head<2>(), x[2], x[3]);
  ball.shading = limb_falloff * (x[3] + x[4]) / x[3];
  MeanImage mean_dn;
  RenderMean({ball}, options, mean_dn);
  return mean_dn;
}

double BoundAt(const Unknowns& x, const SensorNoise& noise, double limb_falloff) {
  Unknowns steps;
  steps << 0.05, 0.05, 0.05, 1, 1, 0.05, 0.05, 0.02;
  const MeanImage mean_dn = RenderOne(x, limb_falloff);
  std::array<MeanImage, kUnknowns> derivatives;
  for (int k = 0; k < kUnknowns; ++k) {
    const Unknowns step = steps[k] * Unknowns::Unit(k);
    derivatives[static_cast<std::size_t>(k)] =
        (RenderOne(x + step, limb_falloff) - RenderOne(x - step, limb_falloff)) / (2 * steps[k]);
  }
  const MeanImage weights = mean_dn.unaryExpr([&](double dn) { return 1 / noise.VarianceDn2(dn); });
  Eigen::Matrix<double, kUnknowns, kUnknowns> fisher;
  for (int i = 0; i < kUnknowns; ++i) {
    for (int j = 0; j < kUnknowns; ++j) {
      fisher(i, j) = (derivatives[static_cast<std::size_t>(i)] *
                      derivatives[static_cast<std::size_t>(j)] * weights)
                         .sum();
    }
  }
  return fisher.inverse().topLeftCorner<2, 2>().trace() / 2;
}

}  // namespace

double CenterBoundPx2(const Scenario& scenario, double diameter_px) {
  const double full_dn = scenario.sensor.full_scale_dn();
  Unknowns x;
  x << 0, 0, diameter_px, (scenario.light.ball_level - scenario.light.background_level) * full_dn,
      scenario.light.background_level * full_dn, 0, 0, scenario.light.blur_px;
  constexpr int kPlaces = 3;  // an axis, over half a pixel: the rest is mirrored
  double sum_px2 = 0;
  for (int i = 0; i < kPlaces * kPlaces; ++i) {
    const Eigen::Vector2d place(i % kPlaces, i / kPlaces);
    x.head<2>() = Eigen::Vector2d::Constant(kSizePx / 2) + (place.array() + 0.5).matrix() / 6;
    sum_px2 += BoundAt(x, scenario.sensor.noise(), scenario.light.limb_falloff);
  }
  return sum_px2 / (kPlaces * kPlaces);
}

Matrix6d PoseFisher(const Scenario& scenario, const Rigid3& world_from_body,
                    const std::function<double(double)>& variance_px2) {
  Matrix6d fisher = Matrix6d::Zero();
  for (const RigCamera& camera : scenario.rig.cameras) {
    for (const Rod& rod : scenario.body.rods) {
      for (const Eigen::Vector3d& p_in_body_mm : rod.balls_in_body_mm) {
        const auto outline = [&](const Vector6d& delta) {
          const Rigid3 pose = Perturb(world_from_body, delta);
          return ProjectSphere(camera.model, camera.cam_from_world * (pose * p_in_body_mm),
                               rod.ball_diameter_mm / 2)
              .value()
              .outline;
        };
        Eigen::Matrix<double, 2, 6> jacobian;
        for (int k = 0; k < 6; ++k) {
          const double h = k < 3 ? 1e-5 : 1e-2;
          jacobian.col(k) = (outline(h * Vector6d::Unit(k)).center_px -
                             outline(-h * Vector6d::Unit(k)).center_px) /
                            (2 * h);
        }
        const ImageEllipse at_truth = outline(Vector6d::Zero());
        const double diameter_px = at_truth.semi_major_px + at_truth.semi_minor_px;
        fisher += jacobian.transpose() * jacobian / variance_px2(diameter_px);
      }
    }
  }
  return fisher;
}

}  // namespace stereomotion::testing
