#include "src/detection/censored_normal.h"

#include <gtest/gtest.h>

#include <cmath>

#include "src/detection/normal_distribution.h"

namespace stereomotion {
namespace {

TEST(CensorNormal, ScoreAndInformationAreTheDerivativesOfTheDeviance) {
  constexpr double kVariance = 2.3;
  constexpr double kStep = 1e-3;
  // Both sides of the place where the tail's series takes over (−5 σ).
  for (double inside = -12; inside < 8; inside += 0.37) {
    const CensoredNormal here = CensorNormal(inside, kVariance);
    const CensoredNormal above = CensorNormal(inside + kStep, kVariance);
    const CensoredNormal below = CensorNormal(inside - kStep, kVariance);
    const double slope = -0.5 * (above.deviance - below.deviance) / (2 * kStep);
    EXPECT_NEAR(here.score, slope, 1e-5 * (1 + std::abs(slope))) << inside;
    EXPECT_NEAR(here.information, -(above.score - below.score) / (2 * kStep), 1e-5) << inside;
  }
}

TEST(CensorNormal, MeanSquareIsThatOfTheCutOffTail) {
  for (const double a : {-8.0, -3.0, -0.5, 0.0, 1.5, 4.0}) {
    // Numbers x (mean 0, σ 1) beyond the bound: x > −a. Midpoint rule.
    double mass = 0;
    double square = 0;
    constexpr double kStep = 1e-4;
    for (double x = -a + kStep / 2; x < std::max(10.0, -a + 6); x += kStep) {
      const double density = std::exp(0.5 * (a < 0 ? a * a : 0.0) - 0.5 * x * x);
      mass += density;
      square += x * x * density;
    }
    EXPECT_NEAR(CensorNormal(a, 1).mean_square, square / mass, 1e-4 * (1 + square / mass)) << a;
  }
}

TEST(CensorNormal, TellsNothingFarInside) {
  const CensoredNormal pixel = CensorNormal(40, 1);
  EXPECT_NEAR(pixel.score, 0, 1e-12);
  EXPECT_NEAR(pixel.deviance, 0, 1e-12);
  EXPECT_LT(pixel.information, 1e-11);
}

}  // namespace
}  // namespace stereomotion
