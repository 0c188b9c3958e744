#include <gtest/gtest.h>

#include <cmath>

#include "stereomotion/motion/time_offset.h"
#include "tests/motion/offset_scene.h"
#include "tests/support/rig_draw.h"
#include "tests/support/statistics.h"

namespace stereomotion::testing {
namespace {

constexpr int kTests = 2;  // consistency checks in this program
constexpr int kRight = 1;

/// Makes data that a rig has seen which is not quite the one that it is handed on with.
MotionData SeeThroughDrawnRig(double offset_s, int frames, std::mt19937_64& rng) {
  MotionData data = See(Swing, frames, offset_s, 1, rng);
  data.rig.covariance = GoodCalibration(data.rig);
  data.rig = DrawRig(data.rig, rng);
  return data;
}

TEST(TimeOffsetRig, CalibrationIsInTheUncertainty) {
  std::mt19937_64 rng = MakeTestRng();
  for (const double offset_s : {0.0, 0.006}) {
    ErrorStatistics errors;
    int significant = 0;
    double largest_common = 0;
    constexpr int kRuns = 60;
    for (int run = 0; run < kRuns; ++run) {
      const auto found = EstimateTimeOffset(SeeThroughDrawnRig(offset_s, 12, rng));
      ASSERT_TRUE(found);
      const double u_s = std::hypot(found->u_s, found->calibration_u_s);
      errors.Add(Eigen::VectorXd::Constant(1, found->offset_s - offset_s),
                 Eigen::MatrixXd::Constant(1, 1, u_s * u_s));
      significant += found->significant ? 1 : 0;
      largest_common = std::max(largest_common, found->calibration_u_s);
    }
    EXPECT_TRUE(IsConsistent(errors, FamilyZ(kTests))) << offset_s;
    EXPECT_EQ(significant, offset_s == 0 ? 0 : kRuns) << offset_s;
    EXPECT_GT(largest_common, 0);
  }
}

/// Turns the right camera by 40 times what a good calibration leaves open (4e-5 rad).
void Bump(MotionData& data) {
  for (const int index : {9, 10, 11}) {
    ChangeParameter(data.rig.cameras[kRight], index, 40 * 4e-5);
  }
}

TEST(TimeOffsetRig, AWrongRigWithoutCovarianceIsNoOffset) {
  std::mt19937_64 rng = MakeTestRng();
  for (int run = 0; run < 5; ++run) {
    MotionData data = See(Swing, 12, 0, 1, rng);
    data.rig.covariance.reset();
    Bump(data);
    const auto found = EstimateTimeOffset(data);
    EXPECT_FALSE(found && found->significant) << 1e3 * found->offset_s;
  }
}

TEST(TimeOffsetRig, AWrongRigThatIsLateToo) {
  std::mt19937_64 rng = MakeTestRng();
  MotionData data = See(Swing, 30, 0.006, 1, rng);
  data.rig.covariance.reset();
  Bump(data);
  const auto found = EstimateTimeOffset(data);
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->significant);
  EXPECT_LT(std::abs(found->offset_s - 0.006), 5 * found->u_s);
}

/// A straight and even path: an offset looks like a right camera that is turned a little.
TEST(TimeOffsetRig, WhatTheRigExplainsAsWellIsWarnedOf) {
  std::mt19937_64 rng = MakeTestRng();
  const auto even = [](double t) {
    return Rigid3{Eigen::Quaterniond::Identity(), t * Eigen::Vector3d(60, 80, 50)};
  };
  MotionData data = See(even, 12, 0.006, 1, rng);
  data.rig.covariance.reset();
  const auto found = EstimateTimeOffset(data);
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->significant);
  EXPECT_NE(found->warning.find("covariance"), std::string::npos) << found->warning;
}

}  // namespace
}  // namespace stereomotion::testing
