#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "stereomotion/detection/detect_balls.h"
#include "stereomotion/simulation/render.h"
#include "tests/support/statistics.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::MakeTestRng;
using testing::Uniform;

SensorNoise UsualNoise() { return {58.8, 8, 0, 255}; }

std::vector<BallObservation> Detect(const Image& image, const SensorNoise& noise = UsualNoise()) {
  DetectionOptions options;
  options.method = DetectorMethod::kWavelet;
  return DetectBalls(image.View(), noise, options);
}

/// Leaves the measured balls: noise alone makes a faint blob now and then, which is flagged.
std::vector<BallObservation> Measured(std::vector<BallObservation> balls) {
  const auto is_flagged = [](const BallObservation& ball) {
    return ball.status != BlobStatus::kOk;
  };
  balls.erase(std::remove_if(balls.begin(), balls.end(), is_flagged), balls.end());
  return balls;
}

RenderOptions Canvas(int size_px = 64) {
  RenderOptions options;
  options.width_px = options.height_px = size_px;
  return options;
}

/// Hides everything beyond a straight, blurred border at `depth_px` inside the ball's limb.
void Hide(const BallImage& ball, double angle_rad, double depth_px, double level_dn,
          MeanImage& mean_dn) {
  constexpr double kBlur_px = 0.66;  // as the ball's: optics and pixels
  for (int v = 0; v < mean_dn.rows(); ++v) {
    for (int u = 0; u < mean_dn.cols(); ++u) {
      const double x = (u - ball.center_px.x()) * std::cos(angle_rad) +
                       (v - ball.center_px.y()) * std::sin(angle_rad);
      const double inside = x - (ball.semi_major_px - depth_px);
      const double cover = 0.5 * std::erfc(-inside / (kBlur_px * std::sqrt(2.0)));
      mean_dn(v, u) += cover * (level_dn - mean_dn(v, u));
    }
  }
}

TEST(WaveletMeasurer, NoiseFreeCentresHaveNoBiasOverThePhases) {
  for (const double diameter_px : {6.0, 9.0, 14.0, 20.0, 30.0}) {
    for (int phase = 0; phase < 9; ++phase) {
      BallImage ball = RoundBall({32 + phase % 3 / 6.0, 32 + phase / 3 / 6.0}, diameter_px, 38400);
      RenderOptions options = Canvas();
      options.bits = 16;
      options.background_dn = 3840;
      Image image;
      RenderBalls({ball}, options, image);
      const auto found = Detect(image, {58.8 / 256, 8, 0, 65535});
      ASSERT_EQ(found.size(), 1U);
      EXPECT_EQ(found[0].status, BlobStatus::kOk);
      // The bound at 40 dB is 0.003 px or more: a fifth of it.
      EXPECT_LT((found[0].center_px - ball.center_px).norm(), 6e-4) << diameter_px << ' ' << phase;
      // Light that falls to the limb by 15 % draws the steepest place 0.08 px inwards.
      EXPECT_NEAR(found[0].diameter_px(), diameter_px, 0.16);
      EXPECT_NEAR(found[0].amplitude_dn, 38400, 0.05 * 38400);
    }
  }
}

TEST(WaveletMeasurer, MirroredAndTransposedImagesGiveThoseCentres) {
  auto rng = MakeTestRng();
  constexpr int kSize = 65;
  for (int i = 0; i < 10; ++i) {
    BallImage ball = RoundBall({Uniform(rng, 30, 34), Uniform(rng, 30, 34)}, 11, 120);
    ball.semi_minor_px = 4.8;
    ball.angle_rad = 0.6;
    RenderOptions options = Canvas(kSize);
    options.noise = UsualNoise();
    options.seed = static_cast<std::uint64_t>(i) + 1;
    Image image, mirrored, transposed;
    RenderBalls({ball}, options, image);
    mirrored.Resize(kSize, kSize, PixelType::kGray8);
    transposed.Resize(kSize, kSize, PixelType::kGray8);
    for (int v = 0; v < kSize; ++v) {
      for (int u = 0; u < kSize; ++u) {
        const auto grey = image.View().Row<std::uint8_t>(v)[u];
        mirrored.Row<std::uint8_t>(v)[kSize - 1 - u] = grey;
        transposed.Row<std::uint8_t>(u)[v] = grey;
      }
    }
    const auto found = Measured(Detect(image));
    const auto in_mirror = Measured(Detect(mirrored));
    const auto swapped = Measured(Detect(transposed));
    ASSERT_EQ(found.size(), 1U);
    ASSERT_EQ(in_mirror.size(), 1U);
    ASSERT_EQ(swapped.size(), 1U);
    // Rays start at other places of the outline: a hundredth of the noise, 0.004 px.
    EXPECT_NEAR(in_mirror[0].center_px.x(), kSize - 1 - found[0].center_px.x(), 4e-4);
    EXPECT_NEAR(in_mirror[0].center_px.y(), found[0].center_px.y(), 4e-4);
    EXPECT_NEAR(swapped[0].center_px.x(), found[0].center_px.y(), 4e-4);
    EXPECT_NEAR(swapped[0].center_px.y(), found[0].center_px.x(), 4e-4);
  }
}

TEST(WaveletMeasurer, EllipseAxesAndAngle) {
  BallImage ball = RoundBall({32.3, 30.8}, 20, 150);
  ball.semi_major_px = 11;
  ball.semi_minor_px = 9;
  ball.angle_rad = 0.6;
  Image image;
  RenderBalls({ball}, Canvas(), image);
  const auto found = Detect(image);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].semi_major_px, 11, 0.15);
  EXPECT_NEAR(found[0].semi_minor_px, 9, 0.15);
  EXPECT_NEAR(found[0].angle_rad, 0.6, 0.02);
}

TEST(WaveletMeasurer, VisibleArcGivesTheCentreWithItsCovariance) {
  auto rng = MakeTestRng();
  testing::ErrorStatistics errors;
  constexpr int kBalls = 120;
  int measured = 0;
  for (int i = 0; i < kBalls; ++i) {
    const BallImage ball = RoundBall({Uniform(rng, 31, 33), Uniform(rng, 31, 33)}, 20, 150);
    RenderOptions options = Canvas();
    MeanImage mean_dn;
    RenderMean({ball}, options, mean_dn);
    Hide(ball, Uniform(rng, 0, 6.28), 3, options.background_dn, mean_dn);  // 9 % of the area
    SensorOptions sensor;
    sensor.noise = SensorNoise{58.8, 60, 0, 255};
    sensor.seed = static_cast<std::uint64_t>(i) + 1;
    Image image;
    Expose(mean_dn, sensor, image);
    const auto found = Detect(image, *sensor.noise);
    for (const BallObservation& seen : found) {
      const Eigen::Vector2d error_px = seen.center_px - ball.center_px;
      if (error_px.norm() > ball.semi_major_px || seen.status != BlobStatus::kOk) continue;
      ++measured;
      errors.Add(error_px, seen.covariance_px2);
    }
  }
  EXPECT_GE(measured, kBalls * 9 / 10);  // an arc that noise leaves in doubt is flagged
  EXPECT_TRUE(testing::IsConsistent(errors, testing::FamilyZ(2)));
}

TEST(WaveletMeasurer, StatusNamesWhatIsWrong) {
  Image image;
  const auto status = [&](const SensorNoise& noise = UsualNoise()) {
    const auto found = Detect(image, noise);
    return found.size() == 1 ? found[0].status : BlobStatus::kOk;
  };
  RenderBalls({RoundBall({3.2, 30}, 12, 150)}, Canvas(), image);
  EXPECT_EQ(status(), BlobStatus::kClipped);
  RenderBalls({RoundBall({32, 30}, 20, 900)}, Canvas(), image);
  EXPECT_EQ(status(), BlobStatus::kSaturated);

  const BallImage ball = RoundBall({32.2, 31.6}, 20, 150);
  MeanImage mean_dn;
  RenderMean({ball}, Canvas(), mean_dn);
  Hide(ball, 0.5, 12, 15, mean_dn);  // well over half of it
  Expose(mean_dn, {}, image);
  EXPECT_EQ(status(), BlobStatus::kPartly);
  BallImage flat = ball;
  flat.semi_minor_px = 5;
  RenderBalls({flat}, Canvas(), image);
  EXPECT_EQ(status(), BlobStatus::kPartly) << "no ball is so flat";

  RenderMean({}, Canvas(), mean_dn);
  for (int v = 24; v < 40; ++v) {
    for (int u = 24; u < 40; ++u) mean_dn(v, u) = 165;  // a square
  }
  Expose(mean_dn, {}, image);
  EXPECT_NE(status(), BlobStatus::kOk);
}

TEST(WaveletMeasurer, SmearedBallIsFlagged) {
  for (const double angle_rad : {0.0, 0.4, 0.8, 1.6}) {
    BallImage ball = RoundBall({32.3, 31.6}, 10, 150);
    ball.smear_px = 10 * Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad));
    RenderOptions canvas = Canvas();
    canvas.noise = UsualNoise();
    Image image;
    RenderBalls({ball}, canvas, image);
    EXPECT_EQ(Measured(Detect(image)).size(), 0U) << angle_rad;
  }
}

TEST(WaveletMeasurer, FaintBallIsFlagged) {
  DetectionOptions options;
  options.method = DetectorMethod::kWavelet;
  options.min_signal_to_noise_db = 30;  // this one has 26 dB
  RenderOptions canvas = Canvas();
  canvas.noise = SensorNoise{58.8, 290, 0, 255};
  Image image;
  RenderBalls({RoundBall({31.7, 32.2}, 14, 100)}, canvas, image);
  int faint = 0;
  for (const BallObservation& ball : DetectBalls(image.View(), *canvas.noise, options)) {
    if ((ball.center_px - Eigen::Vector2d(31.7, 32.2)).norm() > 1) continue;
    EXPECT_EQ(ball.status, BlobStatus::kPoorFit);
    ++faint;
  }
  EXPECT_EQ(faint, 1);
}

}  // namespace
}  // namespace stereomotion
