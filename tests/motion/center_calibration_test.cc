#include <gtest/gtest.h>

#include "stereomotion/motion/spin_center.h"
#include "tests/support/motion_scene.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

SpinCenter CenterOf(const MotionData& data) {
  SpinCenterOptions options;
  options.law = PathLaw::kUniform;
  return *FindSpinCenter(data, options).center;
}

/// With one common unknown of variance u² the calibration's covariance is that of a shift: compare
/// with the shift that an error of u makes.
void ExpectShift(const MotionData& stated, const MotionData& wrong, const MotionData& exact) {
  const SpinCenter told = CenterOf(stated), moved = CenterOf(wrong), truth = CenterOf(exact);
  ASSERT_TRUE(told.calibration_covariance_mm2);
  const Eigen::Vector3d shift_mm = moved.in_body_mm - truth.in_body_mm;
  const Eigen::Matrix3d expected = shift_mm * shift_mm.transpose();
  ASSERT_GT(expected.norm(), 0);
  // First order: an error of u changes the derivative itself by parts in a thousand.
  EXPECT_LT((*told.calibration_covariance_mm2 - expected).norm(), 0.02 * expected.norm());
  const Eigen::Vector3d path_mm = moved.states[3].position_mm - truth.states[3].position_mm;
  ASSERT_TRUE(told.states[3].calibration_u_mm);
  EXPECT_LT((*told.states[3].calibration_u_mm - path_mm.cwiseAbs()).norm(), 0.02 * path_mm.norm());
}

TEST(CenterCalibration, RigParameterMovesTheCentreAsTold) {
  auto rng = testing::MakeTestRng();
  const MotionData exact = testing::MakeMotionScene(testing::UniformMotion(), rng).exact;
  constexpr double kShift_mm = 0.01, kFocal_px = 0.05;
  MotionData stated = exact, wrong = exact;
  stated.rig.covariance = RigCovariance{{{1, 13}}, Eigen::MatrixXd::Constant(1, 1, 1e-4)};
  wrong.rig.cameras[1].cam_from_world.translation_mm.y() += kShift_mm;
  ExpectShift(stated, wrong, exact);
  stated.rig.covariance =
      RigCovariance{{{0, 0}}, Eigen::MatrixXd::Constant(1, 1, kFocal_px * kFocal_px)};
  wrong = exact;
  wrong.rig.cameras[0].model.fx_px += kFocal_px;
  ExpectShift(stated, wrong, exact);
}

TEST(CenterCalibration, BallMovesTheCentreAsTold) {
  auto rng = testing::MakeTestRng();
  const MotionData exact = testing::MakeMotionScene(testing::UniformMotion(), rng).exact;
  constexpr double kShift_mm = 0.01;
  MotionData stated = exact, wrong = exact;
  const auto size = static_cast<Eigen::Index>(3 * exact.balls_in_body_mm.size());
  stated.structure_covariance_mm2 = Eigen::MatrixXd::Zero(size, size);
  stated.structure_covariance_mm2(7, 7) = kShift_mm * kShift_mm;
  wrong.balls_in_body_mm[2].y() += kShift_mm;
  ExpectShift(stated, wrong, exact);
}

TEST(CenterCalibration, CommonErrorOfPosesMovesTheCentreAsTold) {
  auto rng = testing::MakeTestRng();
  const MotionData exact =
      testing::PosesOnly(testing::MakeMotionScene(testing::UniformMotion(), rng).exact);
  constexpr double kTurn_rad = 1e-5;
  MotionData stated = exact, wrong = exact;
  Vector6d u = Vector6d::Zero();
  u[1] = kTurn_rad;
  for (MotionFrame& frame : stated.frames) frame.pose.calibration_u = u;
  for (MotionFrame& frame : wrong.frames) {
    frame.pose.world_from_body = Perturb(frame.pose.world_from_body, u);
  }
  ExpectShift(stated, wrong, exact);
}

TEST(CenterCalibration, NothingStatedNothingTold) {
  auto rng = testing::MakeTestRng();
  const MotionData exact = testing::MakeMotionScene(testing::UniformMotion(), rng).exact;
  EXPECT_FALSE(CenterOf(exact).calibration_covariance_mm2);
  EXPECT_FALSE(CenterOf(exact).states[0].calibration_u_mm);
}

}  // namespace
}  // namespace stereomotion
