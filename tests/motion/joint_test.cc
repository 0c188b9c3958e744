#include "stereomotion/motion/joint.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/motion/noisy_series.h"
#include "tests/support/statistics.h"

namespace stereomotion::testing {
namespace {

const Eigen::Vector3d kInFirst_mm(60, -20, 15), kInSecond_mm(-45, 10, 30);
const Eigen::Vector3d kAxisInFirst = Eigen::Vector3d(0.1, 0.9, 0.3).normalized();
constexpr double kSigma_rad = 3.5e-5, kSigma_mm = 0.008;

/// Both bodies' poses over time: the first moves through the world, the second turns against it.
struct TwoBodies {
  PoseSeries first, second;
};

using Turn = std::function<Eigen::Quaterniond(double)>;

const Eigen::Quaterniond kFirstFromSecond = Eigen::Quaterniond(0.6, 0.2, -0.7, 0.1).normalized();

TwoBodies Exact(int frames, const Turn& turn, std::mt19937_64& rng, double noise = 1) {
  const auto covariance = [&] {
    return DrawPoseCovariance(rng, noise * kSigma_rad, noise * kSigma_mm);
  };
  const auto first = [](double t) {
    const Eigen::Vector3d turned(0.8 * std::sin(7 * t), 0.5 * t, 0.4 * std::cos(5 * t));
    return Rigid3{ExpSO3(turned), {300 * t, 20 * std::sin(9 * t), -10}};
  };
  const auto second = [&](double t) {
    const Rigid3 base = first(t);
    const Eigen::Quaterniond rotation = base.rotation * turn(t) * kFirstFromSecond;
    return Rigid3{rotation, base * kInFirst_mm - rotation * kInSecond_mm};
  };
  return {ExactSeries(frames, 100, first, covariance),
          ExactSeries(frames, 100, second, covariance)};
}

Turn Ball(double range_rad) {
  return [=](double t) {
    return ExpSO3(range_rad / 2 * Eigen::Vector3d(std::sin(20 * t), std::cos(31 * t), t));
  };
}

Turn Hinge(double range_rad) {
  return [=](double t) { return ExpSO3(range_rad * t / 0.29 * kAxisInFirst); };
}

Eigen::Vector3d AxisInSecond() { return kFirstFromSecond.conjugate() * kAxisInFirst; }

Vector6d Centers(const Joint& joint) {
  Vector6d centers;
  centers << joint.center_in_first_mm, joint.center_in_second_mm;
  return centers;
}

Vector6d TrueCenters() {
  Vector6d centers;
  centers << kInFirst_mm, kInSecond_mm;
  return centers;
}

TEST(FindJoint, ExactBall) {
  auto rng = MakeTestRng();
  const TwoBodies bodies = Exact(30, Ball(1), rng);
  const auto joint = FindJoint(bodies.first, bodies.second);
  ASSERT_TRUE(joint);
  EXPECT_NEAR((Centers(*joint) - TrueCenters()).norm(), 0, 1e-8);
  EXPECT_FALSE(joint->free_axis_in_first);
  EXPECT_EQ(joint->dof, 3 * 30 - 6);
  EXPECT_NEAR(joint->rms_mm, 0, 1e-9);
  EXPECT_EQ(joint->verdict.rfind("ball joint", 0), 0U) << joint->verdict;
}

TEST(FindJoint, ExactHinge) {
  auto rng = MakeTestRng();
  const TwoBodies bodies = Exact(30, Hinge(1), rng);
  const auto joint = FindJoint(bodies.first, bodies.second);
  ASSERT_TRUE(joint && joint->free_axis_in_first);
  EXPECT_NEAR(joint->axis_in_first->cross(kAxisInFirst).norm(), 0, 1e-9);
  EXPECT_NEAR(joint->axis_in_second->cross(AxisInSecond()).norm(), 0, 1e-9);
  EXPECT_GT(joint->axis_in_first->dot(kAxisInFirst) * joint->axis_in_second->dot(AxisInSecond()),
            0);
  const Vector6d error = Centers(*joint) - TrueCenters();
  EXPECT_NEAR(error.head<3>().cross(kAxisInFirst).norm(), 0, 1e-7);
  EXPECT_NEAR(error.head<3>().dot(kAxisInFirst), error.tail<3>().dot(AxisInSecond()), 1e-7);
  EXPECT_NEAR(joint->range_of_rotation_rad, 1, 1e-9);
  EXPECT_EQ(joint->verdict.rfind("hinge", 0), 0U) << joint->verdict;
}

TEST(FindJoint, TooFewCommonFrames) {
  auto rng = MakeTestRng();
  TwoBodies bodies = Exact(4, Ball(1), rng);
  bodies.first[0].measured = false;
  bodies.second[3].frame = 17;
  EXPECT_EQ(FindJoint(bodies.first, bodies.second).error(), JointFailure::kTooFewPoses);
}

TEST(FindJoint, OneRodIsNamed) {
  auto rng = MakeTestRng();
  TwoBodies bodies = Exact(4, Ball(1), rng);
  for (PoseSample& pose : bodies.second) pose.free_axis_in_world = Eigen::Vector3d::UnitX();
  EXPECT_EQ(FindJoint(bodies.first, bodies.second).error(), JointFailure::kOneRod);
  EXPECT_EQ(FindJoint(bodies.second, bodies.first).error(), JointFailure::kOneRod);
}

TEST(FindJoint, NoRelativeRotation) {
  auto rng = MakeTestRng();
  TwoBodies bodies = Exact(30, Ball(0), rng);
  bodies = {WithNoise(bodies.first, rng), WithNoise(bodies.second, rng)};
  EXPECT_EQ(FindJoint(bodies.first, bodies.second).error(), JointFailure::kNoRelativeRotation);
}

TEST(FindJoint, NoCommonPointIsSaid) {
  auto rng = MakeTestRng();
  TwoBodies bodies = Exact(30, Ball(1), rng);
  for (std::size_t i = 0; i < bodies.second.size(); ++i) {
    bodies.second[i].world_from_body.translation_mm.x() += i % 2 == 0 ? 0.1 : -0.1;
  }
  const auto joint = FindJoint(bodies.first, bodies.second);
  ASSERT_TRUE(joint);
  EXPECT_NE(joint->verdict.find("no common point"), std::string::npos) << joint->verdict;
  EXPECT_NEAR(joint->rms_mm, 0.1, 0.02);
}

TEST(FindJoint, SwapSwaps) {
  auto rng = MakeTestRng();
  for (const Turn& turn : {Ball(1), Hinge(0.5)}) {
    TwoBodies bodies = Exact(30, turn, rng);
    bodies = {WithNoise(bodies.first, rng), WithNoise(bodies.second, rng)};
    const auto joint = FindJoint(bodies.first, bodies.second);
    const auto other = FindJoint(bodies.second, bodies.first);
    ASSERT_TRUE(joint && other);
    EXPECT_NEAR((joint->center_in_first_mm - other->center_in_second_mm).norm(), 0, 1e-6);
    EXPECT_NEAR((joint->center_in_second_mm - other->center_in_first_mm).norm(), 0, 1e-6);
    EXPECT_NEAR((*joint->axis_in_first - *other->axis_in_second).norm(), 0, 1e-8);
    EXPECT_NEAR(joint->chi2, other->chi2, 1e-6 * joint->chi2);
    const Eigen::Matrix3d here = joint->center_covariance_mm2.topLeftCorner<3, 3>();
    const Eigen::Matrix3d there = other->center_covariance_mm2.bottomRightCorner<3, 3>();
    EXPECT_LT((here - there).norm(), 1e-5 * here.norm());
  }
}

TEST(FindJoint, ChangeOfFrame) {
  auto rng = MakeTestRng();
  TwoBodies bodies = Exact(30, Ball(0.6), rng);
  bodies = {WithNoise(bodies.first, rng), WithNoise(bodies.second, rng)};
  const Rigid3 other{Eigen::Quaterniond(0.3, -0.2, 0.9, 0.1).normalized(), {5, 6, 7}};
  const auto here = FindJoint(bodies.first, bodies.second);
  const auto there =
      FindJoint(InOtherWorld(bodies.first, other), InOtherWorld(bodies.second, other));
  ASSERT_TRUE(here && there);
  EXPECT_NEAR((Centers(*here) - Centers(*there)).norm(), 0, 1e-6);
  EXPECT_TRUE(here->center_covariance_mm2.isApprox(there->center_covariance_mm2, 1e-6));
}

TEST(FindJoint, CovarianceIsTheSpreadOfBall) {
  auto rng = MakeTestRng();
  // The last: noise of the rotation a quarter of its spread, as with skin markers at small range.
  const double z = FamilyZ(6);
  for (const auto& [range, noise] : {std::pair{1.0, 1.0}, {0.1, 1.0}, {0.1, 300.0}}) {
    const TwoBodies exact = Exact(40, Ball(range), rng, noise);
    ErrorStatistics centers, chi2;
    for (int i = 0; i < 300; ++i) {
      const auto joint = FindJoint(WithNoise(exact.first, rng), WithNoise(exact.second, rng));
      ASSERT_TRUE(joint);
      ASSERT_FALSE(joint->free_axis_in_first);
      centers.Add(Centers(*joint) - TrueCenters(), joint->center_covariance_mm2);
      chi2.Add(Eigen::VectorXd::Constant(1, joint->chi2 - joint->dof),
               Eigen::MatrixXd::Constant(1, 1, 2.0 * joint->dof));
    }
    EXPECT_TRUE(IsConsistent(centers, z)) << range << " rad, noise × " << noise;
    EXPECT_LT(std::abs(chi2.bias()), z * chi2.stated_bias_sigma()) << range;
  }
}

TEST(FindJoint, CovarianceIsTheSpreadOfHinge) {
  auto rng = MakeTestRng();
  const double z = FamilyZ(6);
  for (const double range : {1.2, 0.1}) {
    const TwoBodies exact = Exact(30, Hinge(range), rng);
    ErrorStatistics first, second, axis;
    for (int i = 0; i < 300; ++i) {
      const auto joint = FindJoint(WithNoise(exact.first, rng), WithNoise(exact.second, rng));
      ASSERT_TRUE(joint);
      if (!joint->free_axis_in_first) continue;  // level 1e-3
      const auto in_first = Across(kAxisInFirst);
      const auto in_second = Across(AxisInSecond());
      // The place along the axis is a choice: the true one nearest it.
      const double along = (joint->center_in_first_mm - kInFirst_mm).dot(*joint->axis_in_first);
      const Eigen::Vector3d true_axis =
          kAxisInFirst * (joint->axis_in_first->dot(kAxisInFirst) > 0 ? 1 : -1);
      const Eigen::Vector3d true_second = kFirstFromSecond.conjugate() * true_axis;
      const auto covariance = joint->center_covariance_mm2;
      first.Add(in_first * (joint->center_in_first_mm - kInFirst_mm - along * true_axis),
                in_first * covariance.topLeftCorner<3, 3>() * in_first.transpose());
      second.Add(in_second * (joint->center_in_second_mm - kInSecond_mm - along * true_second),
                 in_second * covariance.bottomRightCorner<3, 3>() * in_second.transpose());
      axis.Add(in_first * (*joint->axis_in_first - true_axis),
               in_first * joint->axis_covariance_in_first * in_first.transpose());
    }
    EXPECT_TRUE(IsConsistent(first, z)) << range;
    EXPECT_TRUE(IsConsistent(second, z)) << range;
    EXPECT_TRUE(IsConsistent(axis, z)) << range;
  }
}

}  // namespace
}  // namespace stereomotion::testing
