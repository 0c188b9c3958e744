#include <fmt/format.h>
#include <gtest/gtest.h>

#include "stereomotion/motion/refine_structure.h"
#include "structure_case.h"
#include "tests/support/motion_cases.h"

namespace stereomotion::testing {
namespace {

/// Coverage of 95 ± 2 % at 3.4 σ.
constexpr int kRepetitions = 1400;
constexpr int kTests = 3 * (3 + 1);

class StructureMonteCarlo : public ::testing::TestWithParam<MotionCase> {};

/// A body learned from image points: its balls, in the gauge of the start, which is off by 0.3 mm.
TEST_P(StructureMonteCarlo, BallsOfALearnedBody) {
  std::mt19937_64 rng = MakeTestRng();
  MotionPlan plan = GetParam().plan();
  plan.frames = 12;
  const MotionScene scene = MakeMotionScene(plan, rng);
  const auto start_mm = Shaken(scene.exact.balls_in_body_mm, 0.3, rng);
  const auto last = static_cast<Eigen::Index>(start_mm.size()) - 1;
  CoverageTable table;
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    const auto structure = RefineStructure(UnknownBody(scene, start_mm, rng));
    ASSERT_TRUE(structure);
    const Eigen::VectorXd error = ErrorOf(*structure, scene, start_mm);
    for (const Eigen::Index ball : {Eigen::Index{0}, last / 2, last}) {
      table.Add(fmt::format("ball {}", ball), error.segment<3>(3 * ball),
                structure->covariance_mm2.block<3, 3>(3 * ball, 3 * ball));
    }
    // What no gauge touches: a distance across the body.
    const Eigen::Vector3d way =
        (structure->balls_in_body_mm.back() - structure->balls_in_body_mm.front()).normalized();
    Eigen::VectorXd ends = Eigen::VectorXd::Zero(error.size());
    ends << -way, Eigen::VectorXd::Zero(error.size() - 6), way;
    const auto& truth_mm = scene.exact.balls_in_body_mm;
    AddNumber("distance of first and last",
              (structure->balls_in_body_mm.back() - structure->balls_in_body_mm.front()).norm() -
                  (truth_mm.back() - truth_mm.front()).norm(),
              std::sqrt(ends.dot(structure->covariance_mm2 * ends)), table);
  }
  fmt::print("{}", table.Text(std::string("body learned in ") + GetParam().name));
  EXPECT_TRUE(table.Holds(kRepetitions, FamilyZ(kTests)));
}

INSTANTIATE_TEST_SUITE_P(Motions, StructureMonteCarlo,
                         ::testing::Values(MotionCase{"Precession", PrecessionMotion},
                                           MotionCase{"SmallRange", SmallRangeMotion},
                                           MotionCase{"Random", RandomMotion}),
                         NameOf);

}  // namespace
}  // namespace stereomotion::testing
