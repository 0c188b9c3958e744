#include "stereomotion/detection/measure_ball.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "stereomotion/simulation/render.h"
#include "tests/support/statistics.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::MakeTestRng;
using testing::Uniform;

/// A dim camera: 25 DN of ball over 5 DN of noise, as in a badly lit lens.
SensorNoise DimNoise() { return {2, 6, 0, 255}; }
constexpr double kDiameter_px = 5.7;
constexpr double kAmplitude_dn = 40;
constexpr double kBlur_px = 0.7;

RenderOptions DimImage(std::uint64_t seed) {
  RenderOptions options;
  options.width_px = options.height_px = 48;
  options.background_dn = 40;
  options.blur_px = kBlur_px;
  options.noise = DimNoise();
  options.seed = seed;
  return options;
}

Eigen::Vector2d DrawPlace(std::mt19937_64& rng) {
  return {Uniform(rng, 22, 26), Uniform(rng, 22, 26)};
}

TEST(MeasureBall, NoiseFreeCentreIsExact) {
  auto rng = MakeTestRng();
  for (int draw = 0; draw < 10; ++draw) {
    const Eigen::Vector2d truth_px = DrawPlace(rng);
    RenderOptions options = DimImage(1);
    options.noise.reset();
    options.bits = 16;
    options.background_dn = 40 * 256;
    Image image;
    RenderBalls({RoundBall(truth_px, kDiameter_px, kAmplitude_dn * 256)}, options, image);
    const auto ball =
        MeasureBall(image.View(), {2.0 / 256, 6, 0, 65535}, truth_px + Eigen::Vector2d(0.9, -0.7),
                    {kDiameter_px / 2, kBlur_px});
    ASSERT_TRUE(ball);
    // What the pixels' square aperture leaves beyond its variance of 1/12 (detect_balls_test.cc),
    // and a search that ends at 1e-3.
    EXPECT_LT((ball->center_px - truth_px).norm(), 2e-3);
  }
}

TEST(MeasureBall, CovarianceIsTheSpread) {
  auto rng = MakeTestRng();
  testing::ErrorStatistics errors;
  constexpr int kDraws = 3000;
  for (int draw = 0; draw < kDraws; ++draw) {
    const Eigen::Vector2d truth_px = DrawPlace(rng);
    Image image;
    RenderBalls({RoundBall(truth_px, kDiameter_px, kAmplitude_dn)},
                DimImage(static_cast<std::uint64_t>(draw)), image);
    const auto ball = MeasureBall(image.View(), DimNoise(), truth_px, {kDiameter_px / 2, kBlur_px});
    ASSERT_TRUE(ball) << draw;
    errors.Add(ball->center_px - truth_px, ball->covariance_px2);
  }
  // The M-estimator's efficiency (0.95) is its own, the scale is learned from some 60 pixels of the
  // ball, so that it scatters by a sixth, and a dim ball's limb is not linear in the noise: the
  // NEES may be a tenth off besides its own scatter, 1/√draws per degree of freedom.
  const double scatter = 4 / std::sqrt(static_cast<double>(kDraws));
  EXPECT_NEAR(errors.nees_per_dof(), 1, 0.1 + scatter);
}

/// Centroid of the light over the background within the ball and its blur.
Eigen::Vector2d Centroid(const ImageView& image, const Eigen::Vector2d& near_px) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int v = 0; v < image.height_px; ++v) {
    for (int u = 0; u < image.width_px; ++u) {
      if ((Eigen::Vector2d(u, v) - near_px).norm() > kDiameter_px / 2 + 2 * kBlur_px) continue;
      sum += (image.At(u, v) - 40) * Eigen::Vector3d(u, v, 1);
    }
  }
  return sum.hnormalized();
}

TEST(MeasureBall, GlintMovesTheCentreLittle) {
  auto rng = MakeTestRng();
  double robust2 = 0, centroid2 = 0;
  constexpr int kDraws = 60;
  for (int draw = 0; draw < kDraws; ++draw) {
    const Eigen::Vector2d truth_px = DrawPlace(rng);
    // A drop of light inside the ball, as in the holes of a drilled target.
    const BallImage glint = RoundBall(truth_px + Eigen::Vector2d(0.3, 1.4), 1.6, 400);
    Image image;
    RenderBalls({RoundBall(truth_px, kDiameter_px, kAmplitude_dn), glint},
                DimImage(static_cast<std::uint64_t>(draw)), image);
    const auto ball = MeasureBall(image.View(), DimNoise(), truth_px, {kDiameter_px / 2, kBlur_px});
    ASSERT_TRUE(ball);
    robust2 += (ball->center_px - truth_px).squaredNorm();
    centroid2 += (Centroid(image.View(), truth_px) - truth_px).squaredNorm();
  }
  // What is cut out with the glint leaves the limb on the other side: less than a third of what its
  // light would do, though not as little as without it.
  EXPECT_LT(robust2, centroid2 / 9);
}

TEST(MeasureBall, NothingThereGivesNothing) {
  int found = 0;
  constexpr int kDraws = 300;
  for (int draw = 0; draw < kDraws; ++draw) {
    Image image;
    RenderBalls({}, DimImage(static_cast<std::uint64_t>(draw)), image);
    if (MeasureBall(image.View(), DimNoise(), {24, 24}, {kDiameter_px / 2, kBlur_px})) ++found;
  }
  // Six standard deviations in the best of some ten independent places.
  EXPECT_EQ(found, 0);
}

TEST(MeasureBall, BorderAndDistanceGiveNothing) {
  Image image;
  RenderBalls({RoundBall({5, 24}, kDiameter_px, 150), RoundBall({24, 24}, kDiameter_px, 150)},
              DimImage(1), image);
  const BallShape shape{kDiameter_px / 2, kBlur_px};
  EXPECT_FALSE(MeasureBall(image.View(), DimNoise(), {5, 24}, shape));
  EXPECT_FALSE(MeasureBall(image.View(), DimNoise(), {-100, 24}, shape));
  EXPECT_TRUE(MeasureBall(image.View(), DimNoise(), {25.5, 24}, shape));
  MeasureBallOptions near;
  near.max_shift_px = 1;
  EXPECT_FALSE(MeasureBall(image.View(), DimNoise(), {25.5, 24}, shape, near));
}

TEST(MeasureBall, WrongShapeOrNoiseIsTheCallersMistake) {
  Image image;
  RenderBalls({}, DimImage(1), image);
  EXPECT_THROW(MeasureBall(image.View(), DimNoise(), {24, 24}, {0, 1}), std::invalid_argument);
  EXPECT_THROW(MeasureBall(image.View(), {0, 1, 0, 255}, {24, 24}, {3, 1}), std::invalid_argument);
}

}  // namespace
}  // namespace stereomotion
