#include <gtest/gtest.h>

#include <cmath>

#include "src/detection/segment_blobs.h"
#include "stereomotion/simulation/render.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::MakeTestRng;
using testing::Uniform;

constexpr double kThreshold = 6;

struct Condition {
  double diameter_px;
  double background_dn;
  SensorNoise noise;
};

/// Counts the balls that have a blob within half their radius and of about their area, and the
/// blobs that have no ball.
struct Score {
  int found = 0, balls = 0, false_blobs = 0;
};

bool Matches(const Blob& blob, const BallImage& ball) {
  const Eigen::Vector2d middle(blob.sum_u / blob.area_px, blob.sum_v / blob.area_px);
  const double area = M_PI * ball.semi_major_px * ball.semi_major_px;
  return (middle - ball.center_px).norm() < ball.semi_major_px / 2 && blob.area_px > 0.4 * area &&
         blob.area_px < 1.8 * area;
}

void AddScore(const std::vector<Blob>& blobs, const std::vector<BallImage>& balls, Score& score) {
  int matched = 0;
  for (const BallImage& ball : balls) {
    const auto matches = [&](const Blob& blob) { return Matches(blob, ball); };
    matched += std::any_of(blobs.begin(), blobs.end(), matches) ? 1 : 0;
  }
  score.found += matched;
  score.balls += static_cast<int>(balls.size());
  score.false_blobs += static_cast<int>(blobs.size()) - matched;
}

class WeakLight : public ::testing::TestWithParam<Condition> {};

/// 10 dB: 3.2 sigma of the background; 720 balls a condition, 16 to 768 kpx an image.
TEST_P(WeakLight, BallsAreFound) {
  const Condition condition = GetParam();
  auto rng = MakeTestRng();
  const double sigma = std::sqrt(condition.noise.VarianceDn2(condition.background_dn));
  const double amplitude = std::sqrt(10.0) * sigma;
  const double pitch = condition.diameter_px + 50;
  constexpr int kColumns = 6;
  Score score;
  for (std::uint64_t round = 0; round < 20; ++round) {
    std::vector<BallImage> balls;
    for (int i = 0; i < kColumns * kColumns; ++i) {
      balls.push_back(RoundBall({(i % kColumns + 0.5) * pitch + Uniform(rng, -8, 8),
                                 (i / kColumns + 0.5) * pitch + Uniform(rng, -8, 8)},
                                condition.diameter_px, amplitude));
    }
    RenderOptions options;
    options.width_px = options.height_px = static_cast<int>(kColumns * pitch);
    options.background_dn = condition.background_dn;
    options.noise = condition.noise;
    options.seed = round + 1;
    Image image;
    RenderBalls(balls, options, image);
    BackgroundMap background;
    Segmenter segmenter;
    EstimateBackground(image.View(), condition.noise, 64, background);
    segmenter.Segment(image.View(), background, kThreshold);
    AddScore(segmenter.blobs(), balls, score);
  }
  // Bar: 99.5 %; 720 draws of 99.5 % give 716 ± 1.9, here 3 standard deviations are allowed for.
  EXPECT_GE(score.found, score.balls * 995 / 1000 - 6);
  EXPECT_LE(score.false_blobs, score.balls / 100);  // a ball in pieces, a spot at a ball
}

INSTANTIATE_TEST_SUITE_P(Conditions, WeakLight,
                         ::testing::Values(Condition{6, 15, {20, 10, 0, 255}},
                                           Condition{6, 4, {5.88, 10, 0, 255}},
                                           Condition{10, 15, {20, 10, 0, 255}},
                                           Condition{14, 4, {5.88, 10, 0, 255}},
                                           Condition{30, 60, {20, 10, 0, 255}}));

/// Theory: at a smoothed pixel's 5 sigma, 1.3e6 pixels, correlated over 9, would have 0.4 · 9/4
/// excesses at most, of which the marks of windows (1 in 700 by noise) leave one in hundreds.
TEST(WeakLight, NoiseHasNoBlobs) {
  std::size_t blobs = 0;
  constexpr int kImages = 8;
  for (int i = 0; i < kImages; ++i) {
    RenderOptions options;
    options.width_px = 1280;
    options.height_px = 1024;
    options.background_dn = 4;
    options.noise = SensorNoise{5.88, 10, 0, 255};
    options.seed = static_cast<std::uint64_t>(i) + 1;
    Image image;
    RenderBalls({}, options, image);
    BackgroundMap background;
    Segmenter segmenter;
    EstimateBackground(image.View(), *options.noise, 64, background);
    segmenter.Segment(image.View(), background, kThreshold);
    blobs += segmenter.blobs().size();
  }
  // Bar: 0.1 an image, so 0.8 in all; more than 3 are seen once in 100 times at that rate.
  EXPECT_LE(blobs, 3U);
}

TEST(WeakLight, BlobHasTheBallsHeightAndIsMarked) {
  const SensorNoise noise{20, 10, 0, 255};
  const double sigma = std::sqrt(noise.VarianceDn2(30));
  RenderOptions options;
  options.width_px = options.height_px = 160;
  options.background_dn = 30;
  options.noise = noise;
  Image image;
  BallImage ball = RoundBall({81.3, 78.9}, 24, 4 * sigma);
  ball.shading = 0;
  RenderBalls({ball}, options, image);
  BackgroundMap background;
  Segmenter segmenter;
  EstimateBackground(image.View(), noise, 64, background);
  segmenter.Segment(image.View(), background, kThreshold);
  ASSERT_EQ(segmenter.blobs().size(), 1U);
  const Blob& blob = segmenter.blobs()[0];
  EXPECT_TRUE(blob.is_weak);
  // The mean of some 400 pixels, of those above 3/4 of the highest: nearly all.
  EXPECT_NEAR(blob.peak_dn - blob.background_dn, 4 * sigma, 0.3 * sigma);
  EXPECT_NEAR(blob.noise_dn, sigma, 0.15 * sigma);
}

}  // namespace
}  // namespace stereomotion
