#include <gtest/gtest.h>

#include <cmath>

#include "stereomotion/detection/detect_balls.h"
#include "stereomotion/simulation/render.h"
#include "tests/support/statistics.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::ErrorStatistics;
using testing::FamilyZ;
using testing::IsConsistent;
using testing::MakeTestRng;
using testing::Uniform;

SensorNoise UsualNoise() { return {58.8, 8, 0, 255}; }

std::vector<BallObservation> DetectByCentroid(const Image& image, const SensorNoise& noise) {
  DetectionOptions options;
  options.method = DetectorMethod::kCentroid;
  return DetectBalls(image.View(), noise, options);
}

/// Light that ends as a sharp edge of whole pixels: the centroid is exact.
TEST(CentroidMeasurer, SquareOnASlopeHasItsCentre) {
  Image image;
  image.Resize(80, 70, PixelType::kGray8);
  for (int v = 0; v < 70; ++v) {
    for (int u = 0; u < 80; ++u) {
      const bool inside = u >= 30 && u < 40 && v >= 25 && v < 35;
      image.Row<std::uint8_t>(v)[u] =
          static_cast<std::uint8_t>(10 + (u + v) / 8 + (inside ? 100 : 0));
    }
  }
  const auto found = DetectByCentroid(image, UsualNoise());
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].status, BlobStatus::kOk);
  // The slope is rounded to whole grey values, up to half of one off the plane: its error, of 1/12
  // in the mean square, on 10 · 10 · 100 of light has the lever of the window's radius (9 px).
  const double light = 10 * 10 * 100;
  const double tolerance_px = 5 * std::sqrt(1.0 / 12 * 254) * 4.5 / light;  // 254 pixels, 5 sigma
  EXPECT_NEAR(found[0].center_px.x(), 34.5, tolerance_px);
  EXPECT_NEAR(found[0].center_px.y(), 29.5, tolerance_px);
  EXPECT_NEAR(found[0].semi_major_px, 2 * 10 / std::sqrt(12), 0.02);  // of equal moments
}

struct Condition {
  double diameter_px;
  double amplitude_dn;
  double slope_dn_px;
};

TEST(CentroidMeasurer, ErrorsAreAsStatedAndUnbiased) {
  auto rng = MakeTestRng();
  const Condition conditions[] = {{6, 150, 0},  {9.2, 150, 0}, {20, 150, 0},
                                  {9.2, 20, 0}, {14, 12, 0},   {9.2, 100, 0.05}};
  for (const Condition& condition : conditions) {
    ErrorStatistics errors;
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    double variance = 0;
    for (std::uint64_t round = 0; round < 6; ++round) {
      const double pitch = condition.diameter_px + 24;
      std::vector<BallImage> truth;
      for (int i = 0; i < 64; ++i) {
        truth.push_back(RoundBall({(i % 8 + 0.6) * pitch + Uniform(rng, -1, 1),
                                   (i / 8 + 0.6) * pitch + Uniform(rng, -1, 1)},
                                  condition.diameter_px, condition.amplitude_dn));
      }
      RenderOptions options;
      options.width_px = options.height_px = static_cast<int>(8.2 * pitch);
      options.background_dn = 40;
      options.background_slope_dn_px = {condition.slope_dn_px, 0};
      options.noise = UsualNoise();
      options.seed = round + 1;
      Image image;
      RenderBalls(truth, options, image);
      const auto found = DetectByCentroid(image, UsualNoise());
      for (const BallImage& ball : truth) {
        for (const BallObservation& other : found) {
          const Eigen::Vector2d error = other.center_px - ball.center_px;
          if (error.norm() > 2 || other.status != BlobStatus::kOk) continue;
          errors.Add(error, other.covariance_px2);
          sum += error;
          variance += other.covariance_px2.trace() / 2;
        }
      }
    }
    const int count = errors.samples();
    EXPECT_GT(count, 6 * 64 * 98 / 100) << condition.diameter_px << ' ' << condition.amplitude_dn;
    EXPECT_TRUE(IsConsistent(errors, FamilyZ(12)))
        << condition.diameter_px << ' ' << condition.amplitude_dn << ' ' << errors.nees_per_dof();
    EXPECT_LT(sum.cwiseAbs().maxCoeff() / std::sqrt(variance), FamilyZ(12))
        << condition.diameter_px << ' ' << condition.amplitude_dn;
  }
}

TEST(CentroidMeasurer, NeighbourInTheWindowIsNotReportedAsGood) {
  RenderOptions options;
  options.noise = UsualNoise();
  Image image;
  RenderBalls({RoundBall({24, 30}, 10, 100), RoundBall({37, 30}, 10, 100)}, options, image);
  const auto found = DetectByCentroid(image, UsualNoise());
  EXPECT_EQ(found.size(), 2U);
  for (const BallObservation& ball : found) EXPECT_EQ(ball.status, BlobStatus::kPartly);
}

TEST(CentroidMeasurer, HalfHiddenBallIsPartly) {
  RenderOptions options;
  options.noise = UsualNoise();
  Image image;
  RenderBalls({RoundBall({32, 30}, 14, 150)}, options, image);
  for (int v = 0; v < 64; ++v) std::fill_n(image.Row<std::uint8_t>(v) + 32, 20, 15);
  const auto found = DetectByCentroid(image, UsualNoise());
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].status, BlobStatus::kPartly);
}

TEST(CentroidMeasurer, BallAtTheBorderIsClipped) {
  Image image;
  RenderBalls({RoundBall({4, 30}, 12, 150)}, RenderOptions{}, image);
  const auto found = DetectByCentroid(image, UsualNoise());
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].status, BlobStatus::kClipped);
}

TEST(CentroidMeasurer, FaintBallIsAPoorFit) {
  RenderOptions options;
  options.noise = UsualNoise();
  Image image;
  RenderBalls({RoundBall({32, 30}, 14, 8)}, options, image);
  DetectionOptions detection;
  detection.method = DetectorMethod::kCentroid;
  detection.min_signal_to_noise_db = 30;
  const auto found = DetectBalls(image.View(), UsualNoise(), detection);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].status, BlobStatus::kPoorFit);
}

}  // namespace
}  // namespace stereomotion
