#include "stereomotion/simulation/sensor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace stereomotion {
namespace {

struct Spread {
  double mean = 0, variance = 0;
};

Spread SpreadOf(const ImageView& image) {
  Spread spread;
  const double count = static_cast<double>(image.width_px) * image.height_px;
  for (int v = 0; v < image.height_px; ++v) {
    for (int u = 0; u < image.width_px; ++u) spread.mean += image.At(u, v) / count;
  }
  for (int v = 0; v < image.height_px; ++v) {
    for (int u = 0; u < image.width_px; ++u) {
      spread.variance += std::pow(image.At(u, v) - spread.mean, 2) / (count - 1);
    }
  }
  return spread;
}

/// The family of checks here has 2 × 5 members; |z| ≤ 4.1 keeps their joint level at 99.96 %.
TEST(Expose, MeanAndVarianceFollowTheNoiseModel) {
  constexpr int kSide = 300;
  constexpr double kCount = kSide * kSide;
  SensorOptions options;
  options.bits = 16;
  options.noise = SensorNoise{2.0, 6.0, 100, 65535};
  for (const double mean_dn : {102.5, 115.0, 140.0, 400.0, 5000.0}) {  // 5 to 9800 electrons
    Image image;
    options.stream = static_cast<std::uint64_t>(mean_dn);
    Expose(MeanImage::Constant(kSide, kSide, mean_dn), options, image);
    const Spread spread = SpreadOf(image.View());
    const double variance_dn2 = options.noise->VarianceDn2(mean_dn);
    // Kurtosis of a Poisson number: 3 + 1/mean; it widens the spread of the sample variance.
    const double excess = 1 / ((mean_dn - 100) * 2.0);
    EXPECT_LT(std::fabs(spread.mean - mean_dn), 4.1 * std::sqrt(variance_dn2 / kCount)) << mean_dn;
    EXPECT_LT(std::fabs(spread.variance / variance_dn2 - 1), 4.1 * std::sqrt((2 + excess) / kCount))
        << mean_dn;
  }
}

TEST(Expose, WithoutNoiseItOnlyRoundsAndClips) {
  MeanImage mean_dn(1, 4);
  mean_dn << -3, 17.4, 17.6, 300;
  Image image;
  Expose(mean_dn, {}, image);
  EXPECT_EQ(image.View().At(0, 0), 0);
  EXPECT_EQ(image.View().At(1, 0), 17);
  EXPECT_EQ(image.View().At(2, 0), 18);
  EXPECT_EQ(image.View().At(3, 0), 255);
}

TEST(Expose, ClipsAtTheTopOfItsBits) {
  Image image;
  SensorOptions options;
  options.bits = 12;
  Expose(MeanImage::Constant(2, 2, 1e6), options, image);
  EXPECT_EQ(image.View().type, PixelType::kGray16);
  EXPECT_EQ(image.View().At(1, 1), 4095);
}

TEST(Expose, PixelsAndStreamsAreIndependent) {
  constexpr int kSide = 256;
  SensorOptions options;
  options.noise = SensorNoise{1.0, 5.0, 0, 65535};
  options.bits = 16;
  Image a, b;
  Expose(MeanImage::Constant(kSide, kSide, 1000), options, a);
  options.stream = 1;
  Expose(MeanImage::Constant(kSide, kSide, 1000), options, b);
  double neighbour = 0, stream = 0;
  for (int v = 0; v < kSide; ++v) {
    for (int u = 1; u < kSide; ++u) {
      const double here = a.View().At(u, v) - 1000;
      neighbour += here * (a.View().At(u - 1, v) - 1000);
      stream += here * (b.View().At(u, v) - 1000);
    }
  }
  const double sigma = 1025 * std::sqrt(kSide * (kSide - 1.0));  // of a sum of products
  EXPECT_LT(std::fabs(neighbour), 4.1 * sigma);
  EXPECT_LT(std::fabs(stream), 4.1 * sigma);
}

TEST(Expose, RejectsWrongUse) {
  Image image;
  SensorOptions options;
  options.noise = SensorNoise{0, 1, 0, 255};
  EXPECT_THROW(Expose(MeanImage::Zero(2, 2), options, image), std::invalid_argument);
  options.noise.reset();
  options.bits = 7;
  EXPECT_THROW(Expose(MeanImage::Zero(2, 2), options, image), std::invalid_argument);
}

}  // namespace
}  // namespace stereomotion
