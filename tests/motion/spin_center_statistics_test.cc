#include <gtest/gtest.h>

#include "stereomotion/motion/spin_center.h"
#include "tests/support/motion_scene.h"
#include "tests/support/statistics.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::MotionPlan;

SpinCenterResult FindByLaw(const MotionData& data, PathLaw law) {
  SpinCenterOptions options;
  options.law = law;
  return FindSpinCenter(data, options);
}

/// Errors of the centre in body and of its state, law given, over `kRepetitions` draws.
void ExpectConsistent(const MotionPlan& plan, const testing::SceneOptions& scene_options,
                      bool structure_known) {
  constexpr int kRepetitions = 150, kTests = 2;
  auto rng = testing::MakeTestRng();
  const auto scene = testing::MakeMotionScene(plan, rng, scene_options);
  testing::ErrorStatistics centers, states;
  const int terms = 3 * (1 + static_cast<int>(plan.law));
  for (int i = 0; i < kRepetitions; ++i) {
    MotionData data = testing::Observed(scene, rng);
    if (structure_known && !scene_options.with_space_points) data = testing::PosesOnly(data);
    data.structure_known = structure_known;
    const auto result = FindByLaw(data, plan.law);
    ASSERT_TRUE(result.center);
    centers.Add(result.center->in_body_mm - plan.center_in_body_mm, result.center->covariance_mm2);
    constexpr std::size_t kFrame = 5;
    const CenterState& state = result.center->states[kFrame];
    Eigen::Matrix<double, 9, 1> values;
    values << state.position_mm, state.velocity_mm_s, state.acceleration_mm_s2;
    states.Add((values - testing::TrueState(scene.truth[kFrame])).head(terms),
               state.covariance.topLeftCorner(terms, terms));
  }
  EXPECT_TRUE(testing::IsConsistent(centers, testing::FamilyZ(kTests)));
  EXPECT_TRUE(testing::IsConsistent(states, testing::FamilyZ(kTests)));
}

TEST(SpinCenterStatistics, CovarianceIsTheSpreadFixed) {
  ExpectConsistent(testing::FixedMotion(), {}, true);
}

TEST(SpinCenterStatistics, CovarianceIsTheSpreadUniform) {
  ExpectConsistent(testing::UniformMotion(), {}, true);
}

/// 3° of rotation with 0.06° of noise: Gauss–Newton's information would be too large.
TEST(SpinCenterStatistics, CovarianceIsTheSpreadAtLowSignal) {
  testing::SceneOptions options;
  options.sigma_px = 0.2;
  ExpectConsistent(testing::SmallRangeMotion(), options, true);
}

TEST(SpinCenterStatistics, CovarianceIsTheSpreadUnknownStructure) {
  testing::SceneOptions options;
  options.with_space_points = true;
  MotionPlan plan = testing::FixedMotion();
  plan.frames = 12;
  ExpectConsistent(plan, options, false);
}

}  // namespace
}  // namespace stereomotion
