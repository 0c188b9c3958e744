#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <utility>

#include "../support/rod_scene.h"
#include "../support/statistics.h"
#include "../support/test_rng.h"
#include "stereomotion/detection/detect_balls.h"

namespace stereomotion {
namespace {

using testing::ErrorStatistics;
using testing::MakeTestRng;
using testing::RodScene;
using testing::SceneBar;
using testing::Uniform;

constexpr double kPi = 3.14159265358979323846;
constexpr int kTests = 6;

/// A ball that stands alone; a dark half-plane, as dark as the background, leaves `clear_radii` of
/// it beyond its centre.
RodScene CutBall(double amplitude_dn, double clear_radii, std::mt19937_64& rng) {
  RodScene scene;
  scene.width_px = scene.height_px = 44;
  scene.balls.push_back(
      {{22 + Uniform(rng, -0.5, 0.5), 22 + Uniform(rng, -0.5, 0.5)}, 5.4, amplitude_dn});
  SceneBar bar;
  bar.angle_rad = Uniform(rng, 0, 2 * kPi);
  bar.half_width_px = 60;
  bar.level_dn = scene.background_dn;
  const double across_px = bar.half_width_px + clear_radii * scene.balls[0].radius_px;
  bar.point_px = scene.balls[0].center_px +
                 across_px * Eigen::Vector2d(-std::sin(bar.angle_rad), std::cos(bar.angle_rad));
  scene.bars.push_back(bar);
  return scene;
}

/// Collects the errors of all that is reported as measured.
ErrorStatistics Measure(double amplitude_dn, double clear_radii, int images, std::mt19937_64& rng) {
  constexpr SensorNoise kNoise{5.88, 10, 0, 255};
  ErrorStatistics errors;
  for (int i = 0; i < images; ++i) {
    const RodScene scene = CutBall(amplitude_dn, clear_radii, rng);
    const Image image = RenderRodScene(scene, kNoise, rng);
    for (const BallObservation& ball : DetectBalls(image.View(), kNoise)) {
      if (ball.status != BlobStatus::kOk) continue;
      errors.Add(ball.center_px - scene.balls[0].center_px, ball.covariance_px2);
    }
  }
  return errors;
}

/// Amplitude [DN] and clear part of the radius: 0.69 is a tenth of the area, 0 a half.
class CutLook : public ::testing::TestWithParam<std::pair<double, double>> {};

TEST_P(CutLook, MeasuresTrulyOrSaysNothing) {
  auto rng = MakeTestRng();
  constexpr int kImages = 30;
  const auto [amplitude_dn, clear_radii] = GetParam();
  const ErrorStatistics errors = Measure(amplitude_dn, clear_radii, kImages, rng);
  // Half of what is cut is measured at least: the rest may be flagged.
  EXPECT_GT(errors.samples(), kImages / 2);
  // One-sided: without what the corners of the visible part would tell, σ is on the safe side.
  EXPECT_LT(errors.nees_z(), testing::FamilyZ(kTests));
  EXPECT_LT(errors.worst_z(), 5);
}

INSTANTIATE_TEST_SUITE_P(Cuts, CutLook,
                         ::testing::Values(std::pair{80.0, 0.69}, std::pair{80.0, 0.4},
                                           std::pair{80.0, 0.0}, std::pair{25.0, 0.4},
                                           std::pair{25.0, 0.16}, std::pair{25.0, 0.0}));

}  // namespace
}  // namespace stereomotion
