#include "stereomotion/motion/spin_center.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>

#include "stereomotion/geometry/so3.h"
#include "tests/support/motion_scene.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::MotionPlan;

/// What an error may be where only rounding is left: poses' start is exact to about 1e-10.
constexpr double kRounding_mm = 1e-5;

Eigen::Vector3d Across(const SpinCenter& center, const Eigen::Vector3d& error_mm) {
  if (!center.free_axis_in_body) return error_mm;
  const Eigen::Vector3d& axis = *center.free_axis_in_body;
  return error_mm - axis * axis.dot(error_mm);
}

SpinCenterResult FindByLaw(const MotionData& data, PathLaw law) {
  SpinCenterOptions options;
  options.law = law;
  return FindSpinCenter(data, options);
}

/// The chosen law, centre and states of exact data are the truth.
void ExpectExact(const MotionPlan& plan, bool poses_only) {
  auto rng = testing::MakeTestRng();
  const auto scene = testing::MakeMotionScene(plan, rng);
  const SpinCenterResult result =
      FindSpinCenter(poses_only ? testing::PosesOnly(scene.exact) : scene.exact);
  EXPECT_EQ(result.law, plan.law);
  EXPECT_FALSE(result.evidence_open);
  EXPECT_TRUE(result.left_out.empty());
  ASSERT_TRUE(result.center) << result.verdict;
  const Eigen::Vector3d error_mm = result.center->in_body_mm - plan.center_in_body_mm;
  EXPECT_LT(Across(*result.center, error_mm).norm(), kRounding_mm);
  if (result.center->free_axis_in_body) return;
  for (std::size_t i = 0; i < scene.truth.size(); ++i) {
    const CenterState& state = result.center->states[i];
    EXPECT_LT((state.position_mm - scene.truth[i].center_mm).norm(), kRounding_mm);
    const double rate = plan.rate_hz;
    EXPECT_LT((state.velocity_mm_s - scene.truth[i].velocity_mm_s).norm(), kRounding_mm * rate);
    EXPECT_LT((state.acceleration_mm_s2 - scene.truth[i].acceleration_mm_s2).norm(),
              kRounding_mm * rate * rate);
  }
}

TEST(SpinCenter, ExactFixed) { ExpectExact(testing::FixedMotion(), false); }
TEST(SpinCenter, ExactUniform) { ExpectExact(testing::UniformMotion(), false); }
TEST(SpinCenter, ExactAccelerated) { ExpectExact(testing::AcceleratedMotion(), false); }
TEST(SpinCenter, ExactPrecession) { ExpectExact(testing::PrecessionMotion(), false); }
TEST(SpinCenter, ExactSmallRange) { ExpectExact(testing::SmallRangeMotion(), false); }
TEST(SpinCenter, ExactScrew) { ExpectExact(testing::ScrewMotion(), false); }
TEST(SpinCenter, ExactFromPoses) { ExpectExact(testing::UniformMotion(), true); }

TEST(SpinCenter, OneAxisLeavesTheCentreFreeAlongIt) {
  auto rng = testing::MakeTestRng();
  const MotionPlan plan = testing::SingleAxisMotion();
  const auto scene = testing::MakeMotionScene(plan, rng);
  const SpinCenterResult result = FindSpinCenter(testing::Observed(scene, rng));
  ASSERT_TRUE(result.center && result.center->free_axis_in_body);
  const Eigen::Vector3d axis = *result.center->free_axis_in_body;
  EXPECT_LT(axis.cross(*testing::TrueAxisInBody(plan)).norm(), 1e-3);
  // Nearest the balls' centroid; nothing said along the axis.
  EXPECT_NEAR(axis.dot(result.center->in_body_mm - scene.centroid_in_body_mm), 0, 1e-9);
  EXPECT_LT((result.center->covariance_mm2 * axis).norm(), 1e-12);
  EXPECT_NE(result.verdict.find("not at all along it"), std::string::npos) << result.verdict;
}

/// Points and the poses made of them hold the same information, to second order in the noise.
TEST(SpinCenter, PosesAndPointsAgree) {
  auto rng = testing::MakeTestRng();
  const auto scene = testing::MakeMotionScene(testing::UniformMotion(), rng);
  const MotionData data = testing::Observed(scene, rng);
  const auto points = FindByLaw(data, PathLaw::kUniform);
  const auto poses = FindByLaw(testing::PosesOnly(data), PathLaw::kUniform);
  ASSERT_TRUE(points.center && poses.center);
  const double sigma_mm = std::sqrt(points.center->covariance_mm2.trace());
  EXPECT_LT((points.center->in_body_mm - poses.center->in_body_mm).norm(), 0.01 * sigma_mm);
  EXPECT_TRUE(points.center->covariance_mm2.isApprox(poses.center->covariance_mm2, 0.01));
  EXPECT_TRUE(
      points.center->states[5].covariance.isApprox(poses.center->states[5].covariance, 0.01));
}

TEST(SpinCenter, ChangeOfFrames) {
  auto rng = testing::MakeTestRng();
  const auto scene = testing::MakeMotionScene(testing::UniformMotion(), rng);
  MotionData data = testing::PosesOnly(testing::Observed(scene, rng));
  const auto before = FindByLaw(data, PathLaw::kUniform);
  const Rigid3 other_from_world{ExpSO3({0.4, -1, 2}), {100, -200, 300}};
  const Rigid3 body_from_other{ExpSO3({1, 2, -0.5}), {30, 10, -20}};
  for (MotionFrame& frame : data.frames) {
    const Rigid3 old = frame.pose.world_from_body;
    frame.pose.world_from_body = other_from_world * old * body_from_other;
    // The new origin moves with δθ too; both turn with the world.
    Matrix6d map = Matrix6d::Identity();
    map.bottomLeftCorner<3, 3>() = -Hat(old.rotation * body_from_other.translation_mm);
    Matrix6d turn = Matrix6d::Zero();
    turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() =
        other_from_world.rotation.toRotationMatrix();
    frame.pose.covariance = turn * map * frame.pose.covariance * map.transpose() * turn.transpose();
  }
  for (auto& ball : data.balls_in_body_mm) ball = body_from_other.Inverse() * ball;
  const auto after = FindByLaw(data, PathLaw::kUniform);
  ASSERT_TRUE(before.center && after.center);
  const double sigma_mm = std::sqrt(before.center->covariance_mm2.trace());
  EXPECT_LT((body_from_other * after.center->in_body_mm - before.center->in_body_mm).norm(),
            1e-3 * sigma_mm);
  const Eigen::Matrix3d r = body_from_other.rotation.toRotationMatrix();
  EXPECT_TRUE((r * after.center->covariance_mm2 * r.transpose())
                  .isApprox(before.center->covariance_mm2, 1e-3));
  EXPECT_LT((other_from_world * before.center->states[4].position_mm -
             after.center->states[4].position_mm)
                .norm(),
            1e-3 * sigma_mm);
}

TEST(SpinCenter, GrossFrameIsLeftOut) {
  auto rng = testing::MakeTestRng();
  const auto scene = testing::MakeMotionScene(testing::FixedMotion(), rng);
  MotionData data = testing::PosesOnly(testing::Observed(scene, rng));
  const auto clean = FindSpinCenter(data);
  data.frames[7].pose.world_from_body.translation_mm += Eigen::Vector3d(3, -2, 1);
  const auto result = FindSpinCenter(data);
  EXPECT_TRUE(clean.left_out.empty());
  EXPECT_EQ(result.left_out, std::vector<int>{7});
  ASSERT_TRUE(result.center);
  // One of 24 frames less: the centre moves by a part of its own uncertainty.
  const Eigen::Vector3d moved = result.center->in_body_mm - clean.center->in_body_mm;
  EXPECT_LT(moved.dot(result.center->covariance_mm2.llt().solve(moved)), 1);
}

TEST(SpinCenter, GapsHaveStates) {
  auto rng = testing::MakeTestRng();
  const auto scene = testing::MakeMotionScene(testing::UniformMotion(), rng);
  MotionData data = scene.exact;
  data.frames[4].pose.measured = false;
  const auto result = FindSpinCenter(data);
  ASSERT_TRUE(result.center);
  ASSERT_EQ(result.center->states.size(), data.frames.size());
  EXPECT_LT((result.center->states[4].position_mm - scene.truth[4].center_mm).norm(), kRounding_mm);
}

TEST(SpinCenter, NoRotationNoCentre) {
  auto rng = testing::MakeTestRng();
  MotionPlan plan = testing::UniformMotion();
  plan.first = plan.second = {};
  const auto scene = testing::MakeMotionScene(plan, rng);
  const auto result = FindSpinCenter(testing::Observed(scene, rng));
  EXPECT_FALSE(result.center);
  EXPECT_EQ(result.law, PathLaw::kUniform);  // the path is told, the centre is not
  EXPECT_NE(result.verdict.find("no rotation"), std::string::npos) << result.verdict;
}

TEST(SpinCenter, SmoothPathOfNoLawIsFree) {
  auto rng = testing::MakeTestRng();
  const auto scene = testing::MakeMotionScene(testing::RandomMotion(), rng);
  const auto result = FindSpinCenter(testing::Observed(scene, rng));
  EXPECT_EQ(result.law, PathLaw::kFree);
  EXPECT_FALSE(result.center);
  EXPECT_TRUE(result.left_out.empty());
}

TEST(SpinCenter, LawGivenIsTaken) {
  auto rng = testing::MakeTestRng();
  const auto scene = testing::MakeMotionScene(testing::FixedMotion(), rng);
  const auto result = FindByLaw(testing::Observed(scene, rng), PathLaw::kAccelerated);
  EXPECT_TRUE(result.law_given);
  EXPECT_EQ(result.law, PathLaw::kAccelerated);
  ASSERT_EQ(result.laws.size(), 4U);
  EXPECT_TRUE(result.laws[0].adequate);
}

}  // namespace
}  // namespace stereomotion
