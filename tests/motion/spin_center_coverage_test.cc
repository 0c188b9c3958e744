#include <gtest/gtest.h>

#include "stereomotion/motion/spin_center.h"
#include "tests/support/center_table.h"
#include "tests/support/motion_cases.h"
#include "tests/support/motion_scene.h"
#include "tests/support/statistics.h"
#include "tests/support/test_rng.h"

namespace stereomotion::testing {
namespace {

/// The quick sister of spin_center_monte_carlo_test: it sees σ that are wrong by a fifth.
constexpr int kRepetitions = 100;
constexpr int kTests = 7 * 10;

class SpinCenterCoverage : public ::testing::TestWithParam<MotionCase> {};

TEST_P(SpinCenterCoverage, LawGiven) {
  std::mt19937_64 rng = MakeTestRng();
  MotionPlan plan = GetParam().plan();
  plan.frames = 12;
  const MotionScene scene = MakeMotionScene(plan, rng);
  SpinCenterOptions options;
  options.law = plan.law;
  options.only_given_law = true;
  CoverageTable table;
  StateBounds(scene, plan.law, table);
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    const SpinCenterResult result = FindSpinCenter(Observed(scene, rng), options);
    ASSERT_TRUE(result.center);
    AddCenter(scene, *result.center, table);
  }
  EXPECT_TRUE(table.IsPlausible(FamilyZ(kTests)));
}

INSTANTIATE_TEST_SUITE_P(Motions, SpinCenterCoverage, ::testing::ValuesIn(LawfulMotions()), NameOf);

}  // namespace
}  // namespace stereomotion::testing
