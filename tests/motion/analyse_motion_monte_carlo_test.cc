#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "stereomotion/motion/analyse_motion.h"
#include "tests/support/motion_bound.h"
#include "tests/support/motion_cases.h"
#include "tests/support/motion_scene.h"
#include "tests/support/test_rng.h"

namespace stereomotion::testing {
namespace {

/// Coverage of 95 ± 2 % at 3.4 σ.
constexpr int kRepetitions = 1400;
/// Rows of all tables: of each motion three frames' position, v, a, ω and α.
constexpr int kTests = 7 * 3 * 5;

/// One axis is refused at level 1e-3: 1.4 ± 1.2 of 1 400; 8 or more have a probability of 2e-4.
constexpr int kMostRefused = 7;

struct Watched {
  std::size_t frame;
  const char* name;
};

/// Adds what motion.csv states of a frame: position, v and a of the spin centre by the chosen law,
/// as far as the true one has them, and ω and α.
void AddSample(const MotionScene& scene, const Watched& at, const MotionSample& sample,
               CoverageTable& table) {
  const MotionTruth& truth = scene.truth[at.frame];
  const Eigen::Matrix<double, 9, 1> state = TrueStateOf(truth, IdentifiableCenter(scene));
  const BodyVelocity& velocity = sample.velocity;
  const auto block = [&](Eigen::Index i) { return velocity.covariance.block<3, 3>(i, i); };
  const std::string where = std::string(", ") + at.name;
  table.Add("omega" + where, velocity.omega_rad_s - truth.omega_rad_s, block(0));
  if (velocity.has_acceleration) {
    table.Add("alpha" + where, velocity.alpha_rad_s2 - truth.alpha_rad_s2, block(6));
  }
  AddAcross("position" + where, TrueAxisInWorld(scene.plan),
            sample.center->position_mm - state.head<3>(),
            sample.center->covariance.topLeftCorner<3, 3>(), table);
  if (scene.plan.law >= PathLaw::kUniform) {
    table.Add("v" + where, velocity.velocity_mm_s - state.segment<3>(3), block(3));
  }
  if (scene.plan.law >= PathLaw::kAccelerated) {
    table.Add("a" + where, velocity.acceleration_mm_s2 - state.tail<3>(), block(9));
  }
}

class AnalyseMotionMonteCarlo : public ::testing::TestWithParam<MotionCase> {};

/// Nothing is given: the law is chosen, the time offset estimated.
TEST_P(AnalyseMotionMonteCarlo, WhatTheFilesState) {
  std::mt19937_64 rng = MakeTestRng();
  const MotionPlan plan = GetParam().plan();
  const MotionScene scene = MakeMotionScene(plan, rng);
  const bool one_axis = TrueAxisInBody(plan).has_value();
  CoverageTable table;
  int right = 0, refused = 0, moved = 0;
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    const MotionAnalysis analysis = AnalyseMotion(Observed(scene, rng));
    right += analysis.spin.law == plan.law ? 1 : 0;
    moved += analysis.time_offset && analysis.time_offset->significant ? 1 : 0;
    if (!analysis.spin.center || analysis.spin.center->free_axis_in_body.has_value() != one_axis) {
      ++refused;
      continue;
    }
    const std::size_t n = analysis.samples.size();
    for (const Watched& at : {Watched{0, "first"}, {n / 2, "middle"}, {n - 1, "last"}}) {
      AddSample(scene, at, analysis.samples[at.frame], table);
    }
  }
  fmt::print("{}law right {:.2f} %, axis not told {}, time offset claimed {}\n",
             table.Text(GetParam().name), 100.0 * right / kRepetitions, refused, moved);
  EXPECT_GE(right, 0.95 * kRepetitions);
  EXPECT_LE(refused, kMostRefused);
  EXPECT_LE(moved, 1);  // beyond 4 σ: 0.09 expected
  EXPECT_TRUE(table.Holds(kRepetitions - kMostRefused, FamilyZ(kTests)));
}

INSTANTIATE_TEST_SUITE_P(Motions, AnalyseMotionMonteCarlo, ::testing::ValuesIn(LawfulMotions()),
                         NameOf);

}  // namespace
}  // namespace stereomotion::testing
