#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "stereomotion/motion/spin_center.h"
#include "tests/support/coverage_table.h"
#include "tests/support/motion_bound.h"
#include "tests/support/motion_scene.h"
#include "tests/support/test_rng.h"

namespace stereomotion::testing {
namespace {

constexpr int kRepetitions = 1400;
constexpr int kTests = 2 * 3;

/// A centre that drifts so slowly that the data hardly tells: `separation` is the velocity in units
/// of its own σ (the root of χ²'s noncentrality) when the law is uniform.
MotionScene DriftingScene(double separation, std::mt19937_64& rng) {
  MotionPlan plan = FixedMotion();
  plan.frames = 16;
  const std::size_t middle = 8;
  const MotionBound bound = BoundOf(MakeMotionScene(plan, rng), PathLaw::kUniform);
  const Eigen::Matrix3d covariance = bound.states[middle].block<3, 3>(3, 3);
  const Eigen::Vector3d way = Eigen::Vector3d::Ones();
  plan.velocity_mm_s = separation / std::sqrt(way.dot(covariance.inverse() * way)) * way;
  plan.law = PathLaw::kUniform;
  return MakeMotionScene(plan, rng);
}

class OpenEvidence : public ::testing::TestWithParam<double> {};

/// Whatever is chosen, the interval under the true law stands in `laws` and covers. What the
/// narrower law leaves out while it is preferred is printed: the interval under the chosen law.
TEST_P(OpenEvidence, WiderLawCovers) {
  std::mt19937_64 rng = MakeTestRng();
  const MotionScene scene = DriftingScene(GetParam(), rng);
  CoverageTable wider, chosen;
  int fixed = 0, open = 0;
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    const SpinCenterResult result = FindSpinCenter(Observed(scene, rng));
    fixed += result.law == PathLaw::kFixed ? 1 : 0;
    open += result.evidence_open ? 1 : 0;
    const auto& uniform = result.laws.at(static_cast<std::size_t>(PathLaw::kUniform)).center;
    ASSERT_TRUE(uniform);
    wider.Add("centre, uniform", uniform->in_body_mm - scene.plan.center_in_body_mm,
              uniform->covariance_mm2);
    if (!result.center) continue;
    chosen.Add("centre, chosen law", result.center->in_body_mm - scene.plan.center_in_body_mm,
               result.center->covariance_mm2);
  }
  fmt::print("drift of {} sigma: fixed chosen {:.1f} %, evidence open {:.1f} %\n{}{}", GetParam(),
             100.0 * fixed / kRepetitions, 100.0 * open / kRepetitions, wider.Text(""),
             chosen.Text(""));
  EXPECT_TRUE(wider.Holds(kRepetitions, FamilyZ(kTests)));
}

INSTANTIATE_TEST_SUITE_P(Drifts, OpenEvidence, ::testing::Values(2, 3, 4),
                         [](const auto& one) { return fmt::format("Sigma{}", one.param); });

}  // namespace
}  // namespace stereomotion::testing
