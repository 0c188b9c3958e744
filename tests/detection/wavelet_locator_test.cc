#include "src/detection/wavelet_locator.h"

#include <gtest/gtest.h>

#include <cmath>

#include "src/detection/wavelet_maxima.h"
#include "tests/support/statistics.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::MakeTestRng;
using testing::Normal;
using testing::Uniform;

constexpr int kSize = 40;
constexpr double kAmplitude_dn = 100;
const double kBlur_px = std::sqrt(0.6 * 0.6 + 1.0 / 12.0);

/// A straight edge through the point, dark towards `outward`.
WaveletPlane StraightEdge(const Eigen::Vector2d& through, const Eigen::Vector2d& outward) {
  WaveletPlane image;
  image.Resize(kSize, kSize);
  for (int v = 0; v < kSize; ++v) {
    for (int u = 0; u < kSize; ++u) {
      const double outside = outward.dot(Eigen::Vector2d(u, v) - through);
      image.Row(v)[u] = static_cast<float>(0.5 * kAmplitude_dn *
                                           std::erfc(outside / (kBlur_px * std::sqrt(2.0))));
    }
  }
  return image;
}

TEST(EdgeLocator, StraightEdgesAreFoundWhereTheyLie) {
  auto rng = MakeTestRng();
  const EdgeLocator locator;
  WaveletTransform transform;
  for (int i = 0; i < 100; ++i) {
    const double angle = Uniform(rng, 0, 6.28);
    const Eigen::Vector2d outward(std::cos(angle), std::sin(angle));
    const Eigen::Vector2d place(Uniform(rng, 19, 20), Uniform(rng, 19, 20));
    transform.Forward(StraightEdge(place, outward), kFineScale);
    const auto edge = locator.Locate(transform, place + Uniform(rng, -1, 1) * outward, outward, 2);
    ASSERT_TRUE(edge);
    // By symmetry exact but for what the pixel grid leaves (sampling, the spline's images): less
    // than an eighth of what noise does at 40 dB, 0.02 px.
    EXPECT_NEAR(outward.dot(edge->place - place), 0, 2.5e-3);
  }
}

TEST(EdgeLocator, NoEdgeOnAFlatAFaultyOrABorderingPlace) {
  const EdgeLocator locator;
  WaveletTransform transform;
  const Eigen::Vector2d middle(19.5, 19.5);
  transform.Forward(StraightEdge(middle, {1, 0}), kFineScale);
  EXPECT_TRUE(locator.Locate(transform, middle, {1, 0}, 1));
  EXPECT_FALSE(locator.Locate(transform, middle, {-1, 0}, 1)) << "brighter outwards";
  EXPECT_FALSE(locator.Locate(transform, {16.5, 19.5}, {1, 0}, 1)) << "out of reach";
  EXPECT_FALSE(locator.Locate(transform, {19.5, 8}, {1, 0}, 1)) << "too near to the border";
  WaveletPlane flat;
  flat.Resize(kSize, kSize);
  flat.Fill(7);
  transform.Forward(flat, kFineScale);
  EXPECT_FALSE(locator.Locate(transform, middle, {1, 0}, 1)) << "nothing there";
}

TEST(EdgeLocator, NoiseMovesTheEdgeAsItsSigmaSays) {
  auto rng = MakeTestRng();
  const EdgeLocator locator;
  WaveletTransform transform;
  const Eigen::Vector2d outward = Eigen::Vector2d(0.8, 0.6);
  testing::ErrorStatistics errors;
  for (int i = 0; i < 2500; ++i) {
    const Eigen::Vector2d place(Uniform(rng, 19, 20), Uniform(rng, 19, 20));
    WaveletPlane image = StraightEdge(place, outward);
    constexpr double kNoise_dn = 1;
    for (float& value : image.values) value += static_cast<float>(kNoise_dn * Normal(rng));
    transform.Forward(image, kFineScale);
    const auto edge = locator.Locate(transform, place, outward, 1);
    ASSERT_TRUE(edge);
    const double sigma_px = kNoise_dn * edge->unit_sigma_px;
    errors.Add(Eigen::VectorXd::Constant(1, outward.dot(edge->place - place)),
               Eigen::MatrixXd::Constant(1, 1, sigma_px * sigma_px));
  }
  // The table holds one phase between best and worst: 5 % in the variance.
  EXPECT_NEAR(errors.nees_per_dof(), 1, 0.1);
  EXPECT_LT(std::abs(errors.bias()), 3.3 * errors.stated_bias_sigma() + 1e-3);
}

TEST(WaveletMaxima, ContrastIsIntensifiedAboutTheCrossoverPoint) {
  EXPECT_DOUBLE_EQ(IntensifyContrast(0), 0);
  EXPECT_DOUBLE_EQ(IntensifyContrast(0.5), 0.5);
  EXPECT_DOUBLE_EQ(IntensifyContrast(1), 1);
  EXPECT_DOUBLE_EQ(IntensifyContrast(0.25), 0.125);
  EXPECT_DOUBLE_EQ(IntensifyContrast(0.75), 0.875);
}

TEST(WaveletMaxima, EdgeGivesOneMaximumALine) {
  WaveletTransform transform;
  transform.Forward(StraightEdge({19.3, 0}, {1, 0}));
  WaveletMaxima maxima;
  constexpr int kMargin = 10;
  maxima.Find(transform, kFineScale, 1, kMargin);
  EXPECT_EQ(maxima.points().size(), static_cast<std::size_t>(kSize - 2 * kMargin));
  for (const EdgePoint& point : maxima.points()) {
    EXPECT_NEAR(point.place.x(), 19.3, 0.06);  // a parabola's bias
    EXPECT_NEAR(point.weight, 1, 1e-6);
  }
  maxima.Find(transform, kFineScale, kAmplitude_dn, kMargin);
  EXPECT_TRUE(maxima.points().empty());
}

}  // namespace
}  // namespace stereomotion
