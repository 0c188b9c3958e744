#include "stereomotion/detection/estimate_noise.h"

#include <gtest/gtest.h>

#include "stereomotion/simulation/render.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::MakeTestRng;
using testing::Uniform;

std::vector<Image> NoisyImages(const SensorNoise& noise, double background_dn, double amplitude_dn,
                               int count, int bits = 8) {
  auto rng = MakeTestRng();
  std::vector<Image> images(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) {
    std::vector<BallImage> balls;
    for (int i = 0; i < 20; ++i) {
      balls.push_back(RoundBall(
          {30 + 50 * (i % 5) + Uniform(rng, 0, 1), 30 + 50 * (i / 5) + Uniform(rng, 0, 1)}, 14,
          amplitude_dn));
    }
    RenderOptions options;
    options.width_px = 260;
    options.height_px = 220;
    options.background_dn = background_dn;
    options.noise = noise;
    options.bits = bits;
    options.seed = static_cast<std::uint64_t>(k) + 1;
    RenderBalls(balls, options, images[static_cast<std::size_t>(k)]);
  }
  return images;
}

std::vector<ImageView> Views(const std::vector<Image>& images) {
  std::vector<ImageView> views;
  for (const Image& image : images) views.push_back(image.View());
  return views;
}

void ExpectVariance(const SensorNoise& learned, const SensorNoise& truth, double mean_dn,
                    double relative) {
  EXPECT_NEAR(learned.VarianceDn2(mean_dn) / truth.VarianceDn2(mean_dn), 1, relative) << mean_dn;
}

TEST(EstimateNoise, FindsTheVarianceAtBackgroundAndBall) {
  const SensorNoise truth{58.8, 8, 0, 255};
  const auto images = NoisyImages(truth, 15, 150, 8);
  const auto learned = EstimateNoise(Views(images));
  ASSERT_TRUE(learned);
  // 160 balls with some 70 pixels inside each, 56 cells of 20 differences an image: σ of the
  // variance is √(2/11000) = 1.3 % and √(2/9000) = 1.5 %; 99.9 % lie within 3.3 σ. The middle is
  // interpolated.
  ExpectVariance(*learned, truth, 15, 0.05);
  ExpectVariance(*learned, truth, 90, 0.05);
  ExpectVariance(*learned, truth, 160, 0.045);
}

TEST(EstimateNoise, NearDarknessTheCutOffHalfIsMadeGood) {
  const SensorNoise truth{5.88, 10, 0, 255};
  const auto images = NoisyImages(truth, 2.5, 40, 8);
  const auto learned = EstimateNoise(Views(images));
  ASSERT_TRUE(learned);
  ExpectVariance(*learned, truth, 2.5, 0.06);
  ExpectVariance(*learned, truth, 40, 0.06);
}

// A camera of 12 bits whose first images are dim: nothing in them shows that it goes up to 4095.
TEST(EstimateNoise, TheCamerasOwnBitsTellSaturation) {
  const SensorNoise truth{14.7, 8, 0, 4095};
  auto images = NoisyImages(truth, 60, 600, 8, 12);
  const auto guessed = EstimateNoise(Views(images));
  ASSERT_TRUE(guessed);
  EXPECT_EQ(guessed->saturation_dn, 1023);
  for (Image& image : images) image.SetGreyBits(12);
  const auto learned = EstimateNoise(Views(images));
  ASSERT_TRUE(learned);
  EXPECT_EQ(learned->saturation_dn, 4095);
}

TEST(EstimateNoise, ImagesWithoutBallsTellNothing) {
  const auto images = NoisyImages({58.8, 8, 0, 255}, 15, 0, 2);
  EXPECT_FALSE(EstimateNoise(Views(images)));
  EXPECT_FALSE(EstimateNoise({}));
}

}  // namespace
}  // namespace stereomotion
