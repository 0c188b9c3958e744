#include "motion/law_evidence.h"

#include <gtest/gtest.h>

#include <cmath>

namespace stereomotion {
namespace {

/// Fits with the χ² and BIC of 100 frames with 40 scalar observations each.
std::vector<LawFit> Fits(double fixed, double uniform, double accelerated, double free = 3400) {
  constexpr double kLogRows = 8.294;  // ln 4000
  std::vector<LawFit> fits(4);
  const double chi2[4] = {fixed, uniform, accelerated, free};
  const int parameters[4] = {306, 309, 312, 600};
  for (std::size_t i = 0; i < 4; ++i) {
    fits[i].law = static_cast<PathLaw>(i);
    fits[i].chi2 = chi2[i];
    fits[i].dof = 4000 - parameters[i];
    fits[i].bic = chi2[i] + parameters[i] * kLogRows;
  }
  MarkAdequate(fits);
  return fits;
}

TEST(LawEvidence, NarrowestThatExplainsTheData) {
  const LawChoice choice = ChooseLaw(Fits(3694, 3691, 3688));
  EXPECT_EQ(choice.law, PathLaw::kFixed);
  EXPECT_FALSE(choice.evidence_open);
}

TEST(LawEvidence, WiderWhereItGainsStrongly) {
  const LawChoice choice = ChooseLaw(Fits(3694 + 40, 3691, 3688));
  EXPECT_EQ(choice.law, PathLaw::kUniform);
  EXPECT_FALSE(choice.evidence_open);
}

/// A velocity costs 3 ln 4000 = 24.9: a gain of 22 leaves it open, and the wider law is taken.
TEST(LawEvidence, OpenTakesTheWider) {
  const LawChoice choice = ChooseLaw(Fits(3691 + 22, 3691, 3688));
  EXPECT_EQ(choice.law, PathLaw::kUniform);
  EXPECT_TRUE(choice.evidence_open);
}

TEST(LawEvidence, RefutedLawIsNotTaken) {
  const auto fits = Fits(1e6, 1e5, 3688);
  EXPECT_FALSE(fits[0].adequate);
  EXPECT_FALSE(fits[1].adequate);
  EXPECT_TRUE(fits[2].adequate);
  EXPECT_EQ(ChooseLaw(fits).law, PathLaw::kAccelerated);
}

TEST(LawEvidence, FreeWhereNoLawFits) {
  EXPECT_EQ(ChooseLaw(Fits(1e6, 1e5, 1e4)).law, PathLaw::kFree);
}

/// Noise twice as large as stated (χ² × 4): the frames' own poses show it, so the law stands.
TEST(LawEvidence, LargerNoiseRefutesNothing) {
  const auto fits = Fits(4 * 3694, 4 * 3691, 4 * 3688, 4 * 3400);
  EXPECT_TRUE(fits[0].adequate);
  EXPECT_EQ(ChooseLaw(fits).law, PathLaw::kFixed);
}

/// A third-order term costs 3 ln 4000 = 24.9.
TEST(LawEvidence, CubicThatGainsStronglyBendsOtherwise) {
  const auto fits = Fits(1e6, 1e5, 3688);
  LawFit cubic = fits[2];
  cubic.dof -= 3;
  const auto gaining = [&cubic, &fits](double gain) {
    cubic.chi2 = fits[2].chi2 - gain;
    cubic.bic = fits[2].bic + 24.9 - gain;
    return cubic;
  };
  EXPECT_FALSE(BendsOtherwise(fits, gaining(30)));
  EXPECT_TRUE(BendsOtherwise(fits, gaining(32)));
}

/// AIC: three parameters are worth 6; a law that gains 6 weighs as much as the narrower one.
TEST(LawEvidence, WeightsAreAkaikes) {
  auto fits = Fits(3691 + 6, 3691, 3691);
  WeighLaws(fits);
  EXPECT_NEAR(fits[0].weight, fits[1].weight, 1e-12);
  EXPECT_NEAR(fits[2].weight / fits[1].weight, std::exp(-3.0), 1e-12);
  EXPECT_NEAR(fits[0].weight + fits[1].weight + fits[2].weight, 1, 1e-12);
}

}  // namespace
}  // namespace stereomotion
