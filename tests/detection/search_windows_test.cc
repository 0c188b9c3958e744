#include <gtest/gtest.h>

#include <stdexcept>

#include "stereomotion/detection/detect_balls.h"
#include "stereomotion/simulation/render.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::MakeTestRng;
using testing::Uniform;

SensorNoise UsualNoise() { return {58.8, 8, 0, 255}; }

constexpr int kWidth_px = 330;
constexpr int kHeight_px = 250;

/// Twelve balls, the last four of them too weak for a single pixel.
Image TwelveBalls(std::mt19937_64& rng) {
  std::vector<BallImage> balls;
  for (int i = 0; i < 12; ++i) {
    balls.push_back(RoundBall(
        {45 + 78 * (i % 4) + Uniform(rng, -4, 4), 45 + 75.0 * (i / 4) + Uniform(rng, -4, 4)}, 10,
        i < 8 ? 150 : 4));
  }
  RenderOptions options;
  options.width_px = kWidth_px;
  options.height_px = kHeight_px;
  options.noise = UsualNoise();
  Image image;
  RenderBalls(balls, options, image);
  return image;
}

SearchWindow WindowAround(const BallObservation& ball, int half_px) {
  const int u = static_cast<int>(ball.center_px.x());
  const int v = static_cast<int>(ball.center_px.y());
  return {u - half_px, u + half_px, v - half_px, v + half_px, ball};
}

class SearchWindows : public ::testing::TestWithParam<DetectorMethod> {
 protected:
  static DetectionOptions Options() {
    DetectionOptions options;
    options.method = GetParam();
    return options;
  }
};

TEST_P(SearchWindows, GiveTheBallsOfTheWholeSearch) {
  auto rng = MakeTestRng();
  const Image image = TwelveBalls(rng);
  BallDetector detector(UsualNoise(), Options());
  std::vector<BallObservation> whole;
  detector.Detect(image.View(), whole);
  ASSERT_EQ(whole.size(), 12U);
  std::vector<SearchWindow> windows;
  for (const BallObservation& ball : whole) windows.push_back(WindowAround(ball, 9));
  std::vector<BallObservation> found;
  detector.Detect(image.View(), windows, found);
  ASSERT_EQ(found.size(), whole.size());
  for (std::size_t i = 0; i < whole.size(); ++i) {
    const Eigen::Vector2d difference = found[i].center_px - whole[i].center_px;
    // Fits stop where they expect χ² to gain less than 1e-3: both within some √1e-3 = 0.03 σ of the
    // optimum, as far as its estimate holds.
    const double sigma_px = std::sqrt(whole[i].covariance_px2.trace() / 2);
    EXPECT_LT(difference.norm(), 0.1 * sigma_px) << i;
    EXPECT_EQ(found[i].status, whole[i].status);
  }
}

TEST_P(SearchWindows, BallsOutsideAreNotGivenAndOverlapsGiveOne) {
  auto rng = MakeTestRng();
  const Image image = TwelveBalls(rng);
  BallDetector detector(UsualNoise(), Options());
  std::vector<BallObservation> whole;
  detector.Detect(image.View(), whole);
  ASSERT_EQ(whole.size(), 12U);
  const std::vector<SearchWindow> windows = {
      WindowAround(whole[5], 9), WindowAround(whole[5], 14), {-500, -20, -500, 4000, {}}};
  std::vector<BallObservation> found;
  detector.Detect(image.View(), windows, found);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_LT((found[0].center_px - whole[5].center_px).norm(), 0.01);
  detector.Detect(image.View(), {}, found);
  EXPECT_TRUE(found.empty());
}

TEST_P(SearchWindows, WithoutABackgroundTheWholeImageIsSearched) {
  auto rng = MakeTestRng();
  const Image image = TwelveBalls(rng);
  BallDetector detector(UsualNoise(), Options());
  std::vector<BallObservation> found;
  detector.Detect(image.View(), {{0, 10, 0, 10, {}}}, found);
  EXPECT_EQ(found.size(), 12U);
}

TEST_P(SearchWindows, MaskedBallsAreNotFound) {
  auto rng = MakeTestRng();
  const Image image = TwelveBalls(rng);
  std::vector<BallObservation> whole;
  BallDetector(UsualNoise(), Options()).Detect(image.View(), whole);
  ASSERT_EQ(whole.size(), 12U);
  ImageMask mask(kWidth_px, kHeight_px);
  for (const std::size_t i : {std::size_t{2}, std::size_t{10}}) {  // a bright one, a weak one
    const int u = static_cast<int>(whole[i].center_px.x());
    const int v = static_cast<int>(whole[i].center_px.y());
    for (int row = v - 10; row <= v + 10; ++row) mask.Mark(row, u - 10, u + 10);
  }
  BallDetector detector(UsualNoise(), Options(), mask);
  std::vector<BallObservation> found;
  detector.Detect(image.View(), found);
  EXPECT_EQ(found.size(), 10U);
  for (const BallObservation& ball : found) {
    EXPECT_GT((ball.center_px - whole[2].center_px).norm(), 20);
    EXPECT_GT((ball.center_px - whole[10].center_px).norm(), 20);
  }
  std::vector<SearchWindow> windows;
  for (const BallObservation& ball : whole) windows.push_back(WindowAround(ball, 9));
  detector.Detect(image.View(), windows, found);
  EXPECT_EQ(found.size(), 10U);
}

TEST_P(SearchWindows, MaskOfAnotherSizeIsRefused) {
  auto rng = MakeTestRng();
  const Image image = TwelveBalls(rng);
  BallDetector detector(UsualNoise(), Options(), ImageMask(kWidth_px, kHeight_px - 1));
  std::vector<BallObservation> found;
  EXPECT_THROW(detector.Detect(image.View(), found), std::invalid_argument);
}

INSTANTIATE_TEST_SUITE_P(Methods, SearchWindows,
                         ::testing::Values(DetectorMethod::kMaximumLikelihood,
                                           DetectorMethod::kWavelet, DetectorMethod::kCentroid));

}  // namespace
}  // namespace stereomotion
