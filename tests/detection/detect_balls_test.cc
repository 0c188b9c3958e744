#include "stereomotion/detection/detect_balls.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "stereomotion/simulation/render.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::MakeTestRng;
using testing::Uniform;

SensorNoise UsualNoise() { return {58.8, 8, 0, 255}; }

/// A grid of balls at random subpixel places, with what was drawn.
std::vector<BallImage> BallGrid(int columns, int rows, double diameter_px, std::mt19937_64& rng) {
  std::vector<BallImage> balls;
  const double pitch = diameter_px + 24;
  for (int i = 0; i < columns * rows; ++i) {
    const Eigen::Vector2d place((i % columns + 0.6) * pitch + Uniform(rng, -1, 1),
                                (i / columns + 0.6) * pitch + Uniform(rng, -1, 1));
    balls.push_back(RoundBall(place, diameter_px, 150));
  }
  return balls;
}

RenderOptions Canvas(int columns, int rows, double diameter_px) {
  RenderOptions options;
  options.width_px = static_cast<int>((columns + 0.2) * (diameter_px + 24));
  options.height_px = static_cast<int>((rows + 0.2) * (diameter_px + 24));
  return options;
}

const BallObservation* Nearest(const std::vector<BallObservation>& balls,
                               const Eigen::Vector2d& at) {
  const BallObservation* nearest = nullptr;
  for (const BallObservation& ball : balls) {
    if (!nearest || (ball.center_px - at).norm() < (nearest->center_px - at).norm())
      nearest = &ball;
  }
  return nearest;
}

TEST(DetectBalls, NoiseFreeCentresAreExact) {
  auto rng = MakeTestRng();
  for (const double diameter_px : {6.0, 9.2, 19.0, 30.0}) {
    const auto truth = BallGrid(4, 4, diameter_px, rng);
    RenderOptions options = Canvas(4, 4, diameter_px);
    options.bits = 16;
    options.background_dn = 15 * 256;
    auto bright = truth;
    for (BallImage& ball : bright) ball.amplitude_dn = 150 * 256;
    Image image;
    RenderBalls(bright, options, image);
    const auto found = DetectBalls(image.View(), {58.8 / 256, 8, 0, 65535});
    ASSERT_EQ(found.size(), truth.size());
    for (const BallImage& ball : truth) {
      const BallObservation* nearest = Nearest(found, ball.center_px);
      EXPECT_EQ(nearest->status, BlobStatus::kOk);
      // What the pixels' square aperture leaves beyond its variance of 1/12: a fifth of the bound.
      EXPECT_LT((nearest->center_px - ball.center_px).norm(), 7e-4) << diameter_px;
      EXPECT_NEAR(nearest->diameter_px(), diameter_px, 0.01 * diameter_px);
    }
  }
}

TEST(DetectBalls, EllipseAxesAndAngle) {
  BallImage ball = RoundBall({40.3, 30.8}, 20, 150);
  ball.semi_major_px = 11;
  ball.semi_minor_px = 9;
  ball.angle_rad = 0.6;
  RenderOptions options;
  options.width_px = 80;
  Image image;
  RenderBalls({ball}, options, image);
  const auto found = DetectBalls(image.View(), UsualNoise());
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].semi_major_px, 11, 0.05);
  EXPECT_NEAR(found[0].semi_minor_px, 9, 0.05);
  EXPECT_NEAR(found[0].angle_rad, 0.6, 0.02);
}

TEST(DetectBalls, CovarianceIsTheSpread) {
  auto rng = MakeTestRng();
  double nees = 0;
  int dof = 0;
  for (int round = 0; round < 12; ++round) {
    const auto truth = BallGrid(5, 5, 9.2, rng);
    RenderOptions options = Canvas(5, 5, 9.2);
    options.noise = UsualNoise();
    options.seed = static_cast<std::uint64_t>(round) + 1;
    Image image;
    RenderBalls(truth, options, image);
    const auto found = DetectBalls(image.View(), UsualNoise());
    ASSERT_EQ(found.size(), truth.size());
    for (const BallImage& ball : truth) {
      const BallObservation* nearest = Nearest(found, ball.center_px);
      const Eigen::Vector2d error = nearest->center_px - ball.center_px;
      nees += error.dot(nearest->covariance_px2.inverse() * error);
      dof += 2;
    }
  }
  // 600 degrees of freedom: the two-sided 99.9 % interval of χ²/dof is 1 ± 0.19.
  EXPECT_GT(nees / dof, 0.82);
  EXPECT_LT(nees / dof, 1.20);
}

TEST(DetectBalls, TransposedImageGivesTransposedCentres) {
  auto rng = MakeTestRng();
  RenderOptions options = Canvas(3, 3, 12);
  options.noise = UsualNoise();
  Image image;
  RenderBalls(BallGrid(3, 3, 12, rng), options, image);
  Image turned;
  turned.Resize(options.height_px, options.width_px, PixelType::kGray8);
  for (int v = 0; v < options.height_px; ++v) {
    for (int u = 0; u < options.width_px; ++u) {
      turned.Row<std::uint8_t>(u)[v] = image.Row<std::uint8_t>(v)[u];
    }
  }
  const auto found = DetectBalls(image.View(), UsualNoise());
  const auto transposed = DetectBalls(turned.View(), UsualNoise());
  ASSERT_EQ(found.size(), transposed.size());
  for (const BallObservation& ball : found) {
    const Eigen::Vector2d mirrored(ball.center_px.y(), ball.center_px.x());
    // Both stop within 0.03 σ (0.003 px) of the same optimum.
    EXPECT_LT((Nearest(transposed, mirrored)->center_px - mirrored).norm(), 3e-4);
  }
}

TEST(DetectBalls, StridedViewOfA16BitImageGivesTheSameAsAWholeOne) {
  auto rng = MakeTestRng();
  RenderOptions options = Canvas(3, 3, 12);
  options.bits = 12;
  options.background_dn = 200;
  auto balls = BallGrid(3, 3, 12, rng);
  for (BallImage& ball : balls) ball.amplitude_dn = 2500;
  Image image;
  RenderBalls(balls, options, image);
  ImageView whole = image.View();
  std::vector<std::uint8_t> wide(static_cast<std::size_t>(whole.height_px * 1000));
  for (int v = 0; v < whole.height_px; ++v) {
    std::copy_n(whole.data + v * whole.stride_bytes, 2 * whole.width_px, wide.data() + v * 1000);
  }
  ImageView strided = whole;
  strided.data = wide.data();
  strided.stride_bytes = 1000;
  const SensorNoise noise{4, 8, 0, 4095};
  const auto a = DetectBalls(whole, noise);
  const auto b = DetectBalls(strided, noise);
  ASSERT_EQ(a.size(), 9U);
  ASSERT_EQ(b.size(), 9U);
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].center_px, b[i].center_px);
}

TEST(DetectBalls, BallAtTheBorderIsClipped) {
  RenderOptions options;
  Image image;
  RenderBalls({RoundBall({2, 30}, 12, 150)}, options, image);
  const auto found = DetectBalls(image.View(), UsualNoise());
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].status, BlobStatus::kClipped);
}

TEST(DetectBalls, HalfHiddenBallIsNotReportedAsGood) {
  RenderOptions options;
  options.noise = UsualNoise();
  Image image;
  RenderBalls({RoundBall({32, 30}, 14, 150)}, options, image);
  for (int v = 0; v < 64; ++v) std::fill_n(image.Row<std::uint8_t>(v) + 32, 20, 15);
  for (const BallObservation& ball : DetectBalls(image.View(), UsualNoise())) {
    EXPECT_NE(ball.status, BlobStatus::kOk);
  }
}

TEST(DetectBalls, TwoMergedBallsAreNotReportedAsGood) {
  RenderOptions options;
  options.noise = UsualNoise();
  Image image;
  RenderBalls({RoundBall({28, 30}, 14, 100), RoundBall({38, 32}, 14, 100)}, options, image);
  for (const BallObservation& ball : DetectBalls(image.View(), UsualNoise())) {
    EXPECT_NE(ball.status, BlobStatus::kOk);
  }
}

TEST(DetectBalls, WireAndLampAreNoBalls) {
  Image image;
  image.Resize(300, 200, PixelType::kGray8);
  for (int v = 0; v < 200; ++v) {
    std::fill_n(image.Row<std::uint8_t>(v), 300, 15);
    if (v >= 50 && v < 53) std::fill_n(image.Row<std::uint8_t>(v) + 20, 100, 200);
    if (v >= 80 && v < 190) std::fill_n(image.Row<std::uint8_t>(v) + 150, 120, 255);
  }
  EXPECT_TRUE(DetectBalls(image.View(), UsualNoise()).empty());
}

TEST(DetectBalls, ImagesWithoutContentGiveNothing) {
  for (const int grey : {0, 15, 255}) {
    for (const auto& [width, height] : {std::pair{1, 1}, {3, 200}, {31, 33}, {640, 480}}) {
      Image image;
      image.Resize(width, height, PixelType::kGray8);
      for (int v = 0; v < height; ++v) std::fill_n(image.Row<std::uint8_t>(v), width, grey);
      EXPECT_TRUE(DetectBalls(image.View(), UsualNoise()).empty()) << grey << ' ' << width;
    }
  }
  EXPECT_TRUE(DetectBalls(ImageView{}, UsualNoise()).empty());
}

TEST(DetectBalls, BallWhollySaturatedInsideStillHasItsCentre) {
  RenderOptions options;
  options.noise = UsualNoise();
  Image image;
  RenderBalls({RoundBall({32.37, 30.81}, 14, 600)}, options, image);
  const auto found = DetectBalls(image.View(), UsualNoise());
  ASSERT_EQ(found.size(), 1U);
  const Eigen::Vector2d error = found[0].center_px - Eigen::Vector2d(32.37, 30.81);
  if (found[0].status == BlobStatus::kOk) {
    EXPECT_LT(error.dot(found[0].covariance_px2.inverse() * error),
              18.4);  // 1e-4 tail of χ², 2 dof
  }
}

TEST(DetectBalls, AmongTooManyBlobsTheClearestAreKept) {
  auto rng = MakeTestRng();
  auto balls = BallGrid(6, 6, 10, rng);
  for (std::size_t i = 0; i < balls.size(); ++i)
    balls[i].amplitude_dn = 40 + 4.0 * static_cast<double>(i);
  Image image;
  RenderBalls(balls, Canvas(6, 6, 10), image);
  DetectionOptions options;
  options.max_balls = 5;
  const auto found = DetectBalls(image.View(), UsualNoise(), options);
  ASSERT_EQ(found.size(), 5U);
  for (const BallObservation& ball : found) EXPECT_GT(ball.amplitude_dn, 40 + 4 * 30);
}

TEST(BallDetector, RefusesANoiseModelWithoutGain) {
  EXPECT_THROW(BallDetector({0, 8, 0, 255}), std::invalid_argument);
}

}  // namespace
}  // namespace stereomotion
