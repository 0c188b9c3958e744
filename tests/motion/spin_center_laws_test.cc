#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "stereomotion/motion/spin_center.h"
#include "tests/support/motion_scene.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::MotionPlan;

SpinCenterResult FindIn(const MotionPlan& plan, const SpinCenterOptions& options = {}) {
  auto rng = testing::MakeTestRng();
  const auto scene = testing::MakeMotionScene(plan, rng);
  return FindSpinCenter(testing::Observed(scene, rng), options);
}

TEST(SpinCenterLaws, OnlyTheGivenLawIsFitted) {
  SpinCenterOptions options;
  options.law = PathLaw::kUniform;
  const auto all = FindIn(testing::UniformMotion(), options);
  options.only_given_law = true;
  const auto one = FindIn(testing::UniformMotion(), options);
  ASSERT_EQ(one.laws.size(), 2U);
  EXPECT_EQ(one.laws[0].law, PathLaw::kUniform);
  EXPECT_EQ(one.laws[1].law, PathLaw::kFree);
  ASSERT_TRUE(one.center && all.center);
  EXPECT_EQ(one.center->in_body_mm, all.center->in_body_mm);
  EXPECT_EQ(one.center->covariance_mm2, all.center->covariance_mm2);
}

TEST(SpinCenterLaws, WeightsSumToOne) {
  const auto result = FindIn(testing::UniformMotion());
  double sum = 0;
  for (const LawFit& fit : result.laws) sum += fit.weight;
  EXPECT_NEAR(sum, 1, 1e-12);
  EXPECT_EQ(result.laws[0].weight, 0);  // refuted
  EXPECT_EQ(result.laws[3].weight, 0);  // free
}

/// The average holds the narrow law's share and more than that.
TEST(SpinCenterLaws, UnknownLawIsLessCertain) {
  const auto result = FindIn(testing::FixedMotion());
  ASSERT_TRUE(result.center && result.covariance_law_unknown_mm2) << result.verdict;
  const Eigen::Matrix3d more =
      *result.covariance_law_unknown_mm2 - result.laws[0].weight * result.center->covariance_mm2;
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(more).eigenvalues()[0], 0);
  EXPECT_GT(result.covariance_law_unknown_mm2->trace(), result.center->covariance_mm2.trace());
  EXPECT_TRUE(PositionCovarianceLawUnknown(result, 3));
  EXPECT_NE(result.verdict.find("if the law is not known for sure: ±"), std::string::npos);
}

TEST(SpinCenterLaws, GivenLawIsKnown) {
  SpinCenterOptions options;
  options.law = PathLaw::kFixed;
  const auto result = FindIn(testing::FixedMotion(), options);
  EXPECT_FALSE(result.covariance_law_unknown_mm2);
  EXPECT_FALSE(PositionCovarianceLawUnknown(result, 0));
  EXPECT_EQ(result.verdict.find("not known for sure"), std::string::npos) << result.verdict;
}

TEST(SpinCenterLaws, WidestLawIsNamed) {
  const auto result = FindIn(testing::AcceleratedMotion());
  EXPECT_EQ(result.law, PathLaw::kAccelerated);
  EXPECT_FALSE(result.bends_otherwise);
  EXPECT_NE(result.verdict.find("the centre hangs on it"), std::string::npos) << result.verdict;
}

/// A path that an accelerated one fits so well that free poses do not refute it: the cubic does.
TEST(SpinCenterLaws, CubicRefutesAllLaws) {
  MotionPlan plan = testing::RandomMotion();
  plan.frames = 200;  // the more frames, the more parameters free poses have
  int told = 0;
  for (plan.wander_mm = 1e-3; plan.wander_mm < 0.1; plan.wander_mm *= 1.25) {
    const auto result = FindIn(plan);
    const bool adequate = result.laws[2].adequate;
    if (!adequate || !result.bends_otherwise) continue;
    ++told;
    EXPECT_EQ(result.law, PathLaw::kFree);
    EXPECT_FALSE(result.center);
    EXPECT_NE(result.verdict.find("cubic"), std::string::npos) << result.verdict;
  }
  EXPECT_GT(told, 0);
}

}  // namespace
}  // namespace stereomotion
