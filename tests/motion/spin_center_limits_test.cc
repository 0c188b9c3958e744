#include <gtest/gtest.h>

#include <cmath>

#include "stereomotion/geometry/so3.h"
#include "stereomotion/motion/spin_center.h"
#include "tests/support/motion_scene.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

/// Five balls on a line that swings about a point of that line, or beside it.
MotionData SwingingRod(const Eigen::Vector3d& center_in_body_mm, std::mt19937_64& rng) {
  constexpr double kSigma_mm = 0.03;
  MotionData data;
  for (const double x_mm : {0.0, 40.0, 95.0, 165.0, 250.0}) {
    data.balls_in_body_mm.emplace_back(x_mm, 0, 0);
  }
  for (int t = 0; t < 30; ++t) {
    MotionFrame frame;
    frame.pose.timestamp_ns = 10'000'000LL * t;
    frame.pose.measured = true;
    Rigid3& pose = frame.pose.world_from_body;
    pose.rotation = ExpSO3({0.2 * t, 0, 0}) * ExpSO3({0, 0.4 * std::sin(0.3 * t), 0}) *
                    ExpSO3({0, 0, 0.3 * std::cos(0.2 * t)});
    pose.translation_mm = Eigen::Vector3d(10, 20, 30) - pose.rotation * center_in_body_mm;
    for (int ball = 0; ball < 5; ++ball) {
      const Eigen::Vector3d place_mm = pose * data.balls_in_body_mm[static_cast<std::size_t>(ball)];
      frame.space_points.push_back({ball, place_mm + kSigma_mm * testing::NormalVector<3>(rng),
                                    kSigma_mm * kSigma_mm * Eigen::Matrix3d::Identity()});
    }
    frame.pose.free_axis_in_world = pose.rotation * Eigen::Vector3d::UnitX();
    frame.pose.covariance.diagonal() << Eigen::Vector3d::Constant(1e-8),
        Eigen::Vector3d::Constant(1e-3);
    const Eigen::Vector3d axis = *frame.pose.free_axis_in_world;
    Matrix6d without_roll = Matrix6d::Identity();
    without_roll.topLeftCorner<3, 3>() -= axis * axis.transpose();
    frame.pose.covariance = without_roll * frame.pose.covariance * without_roll;
    data.frames.push_back(frame);
  }
  return data;
}

TEST(SpinCenter, OneRodTellsACentreOnItsLine) {
  auto rng = testing::MakeTestRng();
  const Eigen::Vector3d truth_mm(-60, 0, 0);
  const auto result = FindSpinCenter(SwingingRod(truth_mm, rng));
  EXPECT_EQ(result.law, PathLaw::kFixed) << result.verdict;
  ASSERT_TRUE(result.center) << result.verdict;
  const Eigen::Vector3d error_mm = result.center->in_body_mm - truth_mm;
  EXPECT_LT(error_mm.tail<2>().norm(), 1e-9);
  EXPECT_LT(std::abs(error_mm.x()), 4 * std::sqrt(result.center->covariance_mm2(0, 0)));
  EXPECT_LT(result.center->covariance_mm2(0, 0), 0.1 * 0.1);
  EXPECT_FALSE(FindSpinCenter(SwingingRod({-60, 40, 0}, rng)).center);
}

/// Its roll is arbitrary: the range is that of the rod's directions.
TEST(SpinCenter, RangeOfOneRodIsThatOfItsDirections) {
  auto rng = testing::MakeTestRng();
  const MotionData data = SwingingRod({-60, 0, 0}, rng);
  double range_rad = 0;
  for (const MotionFrame& a : data.frames) {
    for (const MotionFrame& b : data.frames) {
      const Eigen::Vector3d &u = *a.pose.free_axis_in_world, &v = *b.pose.free_axis_in_world;
      range_rad = std::max(range_rad, std::atan2(u.cross(v).norm(), u.dot(v)));
    }
  }
  // A direction's σ is 0.03 mm over the root of the balls' Σ(x − mean)², 200 mm; of many pairs.
  constexpr double kTolerance_rad = 5 * 1.5 * 0.03 / 200;
  EXPECT_NEAR(FindSpinCenter(data).range_of_rotation_rad, range_rad, kTolerance_rad);
}

TEST(SpinCenter, TooFewPosesForALaw) {
  auto rng = testing::MakeTestRng();
  MotionData data = testing::MakeMotionScene(testing::UniformMotion(), rng).exact;
  data.frames.resize(3);
  const auto result = FindSpinCenter(data);
  ASSERT_EQ(result.law, PathLaw::kFree);
  EXPECT_NE(result.verdict.find("too few frames"), std::string::npos) << result.verdict;
}

TEST(SpinCenter, TooFewPoses) {
  auto rng = testing::MakeTestRng();
  MotionData data = testing::MakeMotionScene(testing::FixedMotion(), rng).exact;
  data.frames.resize(1);
  EXPECT_FALSE(FindSpinCenter(data).center);
  data.frames.clear();
  EXPECT_FALSE(FindSpinCenter(data).center);
}

TEST(SpinCenter, ThrowsForDataThatBreaksItsRules) {
  auto rng = testing::MakeTestRng();
  const MotionData good =
      testing::PosesOnly(testing::MakeMotionScene(testing::FixedMotion(), rng).exact);
  MotionData data = good;
  data.frames[3].pose.timestamp_ns = data.frames[2].pose.timestamp_ns;
  EXPECT_THROW(FindSpinCenter(data), std::invalid_argument);
  data = good;
  data.frames[3].pose.covariance.setZero();
  EXPECT_THROW(FindSpinCenter(data), std::invalid_argument);
  SpinCenterOptions options;
  options.reject_sigma = 0;
  EXPECT_THROW(FindSpinCenter(good, options), std::invalid_argument);
  options = {};
  options.path_psd_mm2_s3 = -1;
  EXPECT_THROW(FindSpinCenter(good, options), std::invalid_argument);
  options = {};
  options.only_given_law = true;
  EXPECT_THROW(FindSpinCenter(good, options), std::invalid_argument);
}

/// Balls on a line do not tell their roll: their structure cannot be refined with the motion.
TEST(SpinCenter, ThrowsForUnknownBallsOnOneLine) {
  auto rng = testing::MakeTestRng();
  MotionData data = SwingingRod({-60, 0, 0}, rng);
  data.structure_known = false;
  EXPECT_THROW(FindSpinCenter(data), std::invalid_argument);
}

}  // namespace
}  // namespace stereomotion
