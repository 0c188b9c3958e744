#include <fmt/format.h>
#include <gtest/gtest.h>

#include "stereomotion/motion/joint.h"
#include "tests/support/coverage_table.h"
#include "tests/support/motion_bound.h"
#include "tests/support/test_rng.h"
#include "tests/support/two_body_scene.h"

namespace stereomotion::testing {
namespace {

constexpr int kRepetitions = 1400;
constexpr int kTests = 6;

/// How the second body turns against the first, whose frame is the "world" of this plan.
MotionPlan Relative(MotionPlan plan) {
  plan.center_mm = {40, -30, 25};
  plan.center_in_body_mm = {-35, 20, 30};
  plan.velocity_mm_s.setZero();
  return plan;
}

PoseSeries Draw(const MotionScene& scene, std::mt19937_64& rng) {
  return PosesOf(Observed(scene, rng));
}

TEST(JointMonteCarlo, BallJoint) {
  std::mt19937_64 rng = MakeTestRng();
  const TwoBodyScene scene = MakeTwoBodyScene(UniformMotion(), Relative(PrecessionMotion()), rng);
  CoverageTable table;
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    const auto joint = FindJoint(Draw(scene.first, rng), Draw(scene.second, rng));
    ASSERT_TRUE(joint);
    ASSERT_FALSE(joint->free_axis_in_first);
    table.Add("centre in first", joint->center_in_first_mm - scene.center_in_first_mm,
              joint->center_covariance_mm2.topLeftCorner<3, 3>());
    table.Add("centre in second", joint->center_in_second_mm - scene.center_in_second_mm,
              joint->center_covariance_mm2.bottomRightCorner<3, 3>());
  }
  fmt::print("{}", table.Text("ball joint"));
  EXPECT_TRUE(table.Holds(kRepetitions, FamilyZ(kTests)));
}

TEST(JointMonteCarlo, Hinge) {
  std::mt19937_64 rng = MakeTestRng();
  const TwoBodyScene scene = MakeTwoBodyScene(UniformMotion(), Relative(SingleAxisMotion()), rng);
  const auto first = Across(scene.axis_in_first);
  const auto second = Across(scene.axis_in_second);
  const auto add = [](const char* quantity, const Eigen::Matrix<double, 3, 2>& ways,
                      const Eigen::Vector3d& error, const Eigen::Matrix3d& covariance,
                      CoverageTable& table) {
    table.Add(quantity, ways.transpose() * error, ways.transpose() * covariance * ways);
  };
  // The point of the axis that `Joint` gives: c₁·a₁ + c₂·a₂ = 0.
  const double along_mm = (scene.center_in_first_mm.dot(scene.axis_in_first) +
                           scene.center_in_second_mm.dot(scene.axis_in_second)) /
                          2;
  const Eigen::Vector3d in_first_mm = scene.center_in_first_mm - along_mm * scene.axis_in_first;
  const Eigen::Vector3d in_second_mm = scene.center_in_second_mm - along_mm * scene.axis_in_second;
  CoverageTable table;
  int not_hinge = 0;
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    const auto joint = FindJoint(Draw(scene.first, rng), Draw(scene.second, rng));
    ASSERT_TRUE(joint);
    if (!joint->free_axis_in_first || !joint->axis_in_first || !joint->axis_in_second) {
      ++not_hinge;
      continue;
    }
    add("centre in first", first, joint->center_in_first_mm - in_first_mm,
        joint->center_covariance_mm2.topLeftCorner<3, 3>(), table);
    add("centre in second", second, joint->center_in_second_mm - in_second_mm,
        joint->center_covariance_mm2.bottomRightCorner<3, 3>(), table);
    const double sense = joint->axis_in_first->dot(scene.axis_in_first) > 0 ? 1 : -1;
    add("axis in first", first, sense * *joint->axis_in_first - scene.axis_in_first,
        joint->axis_covariance_in_first, table);
    add("axis in second", second, sense * *joint->axis_in_second - scene.axis_in_second,
        joint->axis_covariance_in_second, table);
  }
  fmt::print("{}", table.Text("hinge"));
  EXPECT_LE(not_hinge, 7);  // level 1e-3: 1.4 of 1 400 expected
  EXPECT_TRUE(table.Holds(kRepetitions - 7, FamilyZ(kTests)));
}

}  // namespace
}  // namespace stereomotion::testing
