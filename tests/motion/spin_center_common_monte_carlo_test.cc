#include <fmt/format.h>
#include <gtest/gtest.h>

#include "stereomotion/motion/spin_center.h"
#include "tests/support/coverage_table.h"
#include "tests/support/motion_bound.h"
#include "tests/support/motion_scene.h"
#include "tests/support/rig_draw.h"
#include "tests/support/test_rng.h"

namespace stereomotion::testing {
namespace {

constexpr int kRepetitions = 1400;
constexpr int kTests = 6;

SpinCenterOptions Given(PathLaw law) {
  SpinCenterOptions options;
  options.law = law;
  options.reject_sigma = 1e6;  // a wrong rig inflates all residuals alike
  return options;
}

/// Adds the common part's errors: in the body's frame, and in the world at mid-run, where only the
/// standard uncertainties are stated.
void AddCommon(const MotionScene& scene, const SpinCenterResult& result, CoverageTable& table) {
  ASSERT_TRUE(result.center && result.center->calibration_covariance_mm2);
  const Eigen::Vector3d truth_mm = scene.plan.center_in_body_mm;
  table.Add("centre in body", result.center->in_body_mm - truth_mm,
            *result.center->calibration_covariance_mm2);
  const std::size_t middle = scene.truth.size() / 2;
  const CenterState& state = result.center->states[middle];
  ASSERT_TRUE(state.calibration_u_mm);
  for (int axis = 0; axis < 3; ++axis) {
    table.Add(fmt::format("position in world, {}", "xyz"[axis]),
              (state.position_mm - scene.truth[middle].center_mm).segment<1>(axis),
              state.calibration_u_mm->cwiseAbs2().segment<1>(axis));
  }
}

TEST(SpinCenterCommonMonteCarlo, RigsAndBodiesDrawnFromTheirCovariance) {
  std::mt19937_64 rng = MakeTestRng();
  MotionScene scene = MakeMotionScene(UniformMotion(), rng);
  scene.exact.rig.covariance = GoodCalibration(scene.exact.rig);
  constexpr double kBodySigma_mm = 0.01;
  const auto size = static_cast<Eigen::Index>(3 * scene.exact.balls_in_body_mm.size());
  scene.exact.structure_covariance_mm2 =
      kBodySigma_mm * kBodySigma_mm * Eigen::MatrixXd::Identity(size, size);
  CoverageTable table;
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    std::vector<Eigen::Vector3d> balls_mm = scene.exact.balls_in_body_mm;
    for (Eigen::Vector3d& ball_mm : balls_mm) ball_mm += kBodySigma_mm * NormalVector<3>(rng);
    const MotionData data = SeenOtherwise(scene, DrawRig(scene.exact.rig, rng), balls_mm);
    AddCommon(scene, FindSpinCenter(data, Given(PathLaw::kUniform)), table);
  }
  fmt::print("{}", table.Text("calibration and body"));
  EXPECT_TRUE(table.Holds(kRepetitions, FamilyZ(kTests)));
}

/// The structure starts off by 0.3 mm. The gauge holds the start's mean and turn, so the truth is
/// moved into it by the least-squares alignment, whose condition is the gauge's.
TEST(SpinCenterCommonMonteCarlo, StructureUnknown) {
  std::mt19937_64 rng = MakeTestRng();
  MotionScene scene = MakeMotionScene(PrecessionMotion(), rng);
  Eigen::Matrix3Xd truth_mm(3, static_cast<Eigen::Index>(scene.exact.balls_in_body_mm.size()));
  Eigen::Matrix3Xd start_mm = truth_mm;
  for (Eigen::Index i = 0; i < truth_mm.cols(); ++i) {
    Eigen::Vector3d& ball_mm = scene.exact.balls_in_body_mm[static_cast<std::size_t>(i)];
    truth_mm.col(i) = ball_mm;
    ball_mm += 0.3 * NormalVector<3>(rng);
    start_mm.col(i) = ball_mm;
  }
  scene.exact.structure_known = false;
  const Eigen::Vector3d center_mm = AlignPoints(truth_mm, start_mm) * scene.plan.center_in_body_mm;
  CoverageTable table;
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    const SpinCenterResult result = FindSpinCenter(Observed(scene, rng), Given(scene.plan.law));
    ASSERT_TRUE(result.center);
    table.Add("centre in body", result.center->in_body_mm - center_mm,
              result.center->covariance_mm2);
    const CenterState& state = result.center->states.front();
    table.Add("position in world", state.position_mm - scene.truth.front().center_mm,
              state.covariance.topLeftCorner<3, 3>());
  }
  fmt::print("{}", table.Text("structure unknown"));
  EXPECT_TRUE(table.Holds(kRepetitions, FamilyZ(kTests)));
}

}  // namespace
}  // namespace stereomotion::testing
