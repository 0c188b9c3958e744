#include "stereomotion/simulation/render.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <stdexcept>

#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::MakeTestRng;
using testing::Uniform;

struct Moments {
  double light = 0;
  Eigen::Vector2d centroid_px = Eigen::Vector2d::Zero();
  Eigen::Matrix2d variance_px2 = Eigen::Matrix2d::Zero();
};

Moments MomentsOf(const MeanImage& image, double background_dn) {
  Moments moments;
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  for (Eigen::Index v = 0; v < image.rows(); ++v) {
    for (Eigen::Index u = 0; u < image.cols(); ++u) {
      const double light = image(v, u) - background_dn;
      const Eigen::Vector2d p(u, v);
      moments.light += light;
      moments.centroid_px += light * p;
      second += light * p * p.transpose();
    }
  }
  moments.centroid_px /= moments.light;
  moments.variance_px2 =
      second / moments.light - moments.centroid_px * moments.centroid_px.transpose();
  return moments;
}

/// ∫ of 1 − q (1 − √(1 − ρ²)) over the unit disc is π (1 − q/3).
double ExactLight(const BallImage& ball) {
  return M_PI * ball.semi_major_px * ball.semi_minor_px * ball.amplitude_dn *
         (1 - ball.shading / 3);
}

BallImage RandomBall(std::mt19937_64& rng) {
  BallImage ball;
  ball.center_px = {Uniform(rng, 30, 34), Uniform(rng, 30, 34)};
  ball.semi_major_px = Uniform(rng, 2, 12);
  ball.semi_minor_px = ball.semi_major_px * Uniform(rng, 0.8, 1);
  ball.angle_rad = Uniform(rng, -1.5, 1.5);
  ball.shading = Uniform(rng, 0, 0.3);
  return ball;
}

/// Below a blur of 0.5 px the pixel grid itself aliases (exp(−2π²σ²)): a real image's centroid is
/// then off as well.
TEST(RenderMean, LightAndCentroidEqualTheTruth) {
  auto rng = MakeTestRng();
  RenderOptions options;
  MeanImage mean_dn;
  for (int i = 0; i < 40; ++i) {
    const BallImage ball = RandomBall(rng);
    options.blur_px = Uniform(rng, 0.5, 1.2);
    RenderMean({ball}, options, mean_dn);
    const Moments moments = MomentsOf(mean_dn, options.background_dn);
    EXPECT_NEAR(moments.light / ExactLight(ball), 1, 2e-4) << ball.semi_major_px;
    EXPECT_LT((moments.centroid_px - ball.center_px).norm(), 2e-4) << ball.semi_major_px;
  }
}

/// Variances add: flat disc R²/4, blur σ², pixel 1/12, smear L²/12.
TEST(RenderMean, SecondMomentsAdd) {
  RenderOptions options;
  MeanImage mean_dn;
  for (const double blur_px : {0.6, 0.8, 1.1}) {
    for (const double smear_px : {0.0, 0.7, 6.0}) {
      BallImage ball = RoundBall({31.7, 32.4}, 9, 100);
      ball.shading = 0;
      ball.smear_px = {smear_px, 0};
      options.blur_px = blur_px;
      RenderMean({ball}, options, mean_dn);
      const Moments moments = MomentsOf(mean_dn, options.background_dn);
      const double across_px2 = 4.5 * 4.5 / 4 + blur_px * blur_px + 1.0 / 12;
      EXPECT_NEAR(moments.variance_px2(1, 1), across_px2, 1e-3);
      EXPECT_NEAR(moments.variance_px2(0, 0), across_px2 + smear_px * smear_px / 12, 2e-3);
    }
  }
}

/// Without blur a pixel's value is the area that a disc of radius 2 about a pixel corner cuts from
/// it.
TEST(RenderMean, PixelsAreAreasWithoutBlur) {
  RenderOptions options;
  options.width_px = options.height_px = 8;
  options.blur_px = 0;
  options.background_dn = 0;
  BallImage ball = RoundBall({3.5, 3.5}, 4, 1);
  ball.shading = 0;
  MeanImage mean_dn;
  RenderMean({ball}, options, mean_dn);
  EXPECT_NEAR(mean_dn(3, 3), 1, 1e-12);
  // The pixel [1, 2] × [0, 1]: ∫ min(1, √(4 − x²)) dx, which leaves the pixel's top at x = √3.
  const double side = std::sqrt(3.0) - 1 + M_PI - (2 * M_PI / 3 + std::sqrt(3.0) / 2);
  EXPECT_NEAR(mean_dn(3, 5), side, 2e-4);
  EXPECT_NEAR(mean_dn.sum(), 4 * M_PI, 4e-4 * M_PI);
}

TEST(RenderMean, MirrorsWithTheScene) {
  auto rng = MakeTestRng();
  RenderOptions options;
  options.background_slope_dn_px = {0.2, -0.1};
  BallImage ball = RandomBall(rng);
  MeanImage image, mirrored;
  RenderMean({ball}, options, image);
  ball.center_px.x() = options.width_px - 1 - ball.center_px.x();
  ball.angle_rad = -ball.angle_rad;
  options.background_slope_dn_px.x() *= -1;
  RenderMean({ball}, options, mirrored);
  EXPECT_LT((image - mirrored.rowwise().reverse()).abs().maxCoeff(), 1e-9);
}

TEST(RenderMean, ShiftsByWholePixels) {
  RenderOptions options;
  MeanImage here, there;
  RenderMean({RoundBall({20.3, 30.6}, 9, 100)}, options, here);
  RenderMean({RoundBall({23.3, 28.6}, 9, 100)}, options, there);
  EXPECT_LT((here.block(10, 10, 40, 30) - there.block(8, 13, 40, 30)).abs().maxCoeff(), 1e-9);
}

TEST(RenderMean, BallsBeyondTheBorderAreCut) {
  RenderOptions options;
  options.background_dn = 0;
  BallImage ball = RoundBall({-0.5, 20}, 10, 100);
  ball.shading = 0;
  MeanImage mean_dn;
  RenderMean({ball, RoundBall({500, 500}, 10, 100)}, options, mean_dn);
  EXPECT_NEAR(mean_dn.sum(), ExactLight(ball) / 2, 1e-3 * ExactLight(ball));
}

TEST(RenderBalls, RejectsWrongUse) {
  Image image;
  RenderOptions options;
  EXPECT_THROW(RenderBalls({RoundBall({9, 9}, 0, 9)}, options, image), std::invalid_argument);
  options.bits = 17;
  EXPECT_THROW(RenderBalls({}, options, image), std::invalid_argument);
  options = {};
  options.width_px = 0;
  EXPECT_THROW(RenderBalls({}, options, image), std::invalid_argument);
  options = {};
  options.blur_px = -1;
  EXPECT_THROW(RenderBalls({}, options, image), std::invalid_argument);
}

TEST(RenderBalls, SameSeedSameBytesOtherSeedOtherBytes) {
  RenderOptions options;
  options.noise = SensorNoise{};
  Image first, second, other;
  RenderBalls({RoundBall({30, 30}, 9, 100)}, options, first);
  RenderBalls({RoundBall({30, 30}, 9, 100)}, options, second);
  options.seed = 2;
  RenderBalls({RoundBall({30, 30}, 9, 100)}, options, other);
  bool same = true, differs = false;
  for (int v = 0; v < 64; ++v) {
    same = same && std::memcmp(first.Row<std::uint8_t>(v), second.Row<std::uint8_t>(v), 64) == 0;
    differs =
        differs || std::memcmp(first.Row<std::uint8_t>(v), other.Row<std::uint8_t>(v), 64) != 0;
  }
  EXPECT_TRUE(same);
  EXPECT_TRUE(differs);
}

}  // namespace
}  // namespace stereomotion
