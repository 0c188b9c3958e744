#include "pipeline/local_motion.h"

#include <gtest/gtest.h>

#include "stereomotion/geometry/so3.h"

namespace stereomotion::testing {
namespace {

const Eigen::Vector3d kPivotMm(10, -20, 5);
const Eigen::Vector3d kRate(0.3, -2, 1), kVelocity(100, 20, -5), kAcceleration(30, -200, 500);

/// A pivot that is accelerated evenly, and an even turn: exactly what the fit assumes.
TimedPlacement At(double time_s) {
  const Rigid3 start{ExpSO3({0.2, 0.5, -0.1}), {1, 2, 3}};
  const Eigen::Vector3d pivot_mm =
      start * kPivotMm + time_s * kVelocity + 0.5 * time_s * time_s * kAcceleration;
  TimedPlacement placement{time_s, {}};
  placement.world_from_body.rotation = ExpSO3(time_s * kRate) * start.rotation;
  placement.world_from_body.translation_mm =
      pivot_mm - placement.world_from_body.rotation * kPivotMm;
  return placement;
}

TEST(FitLocalMotion, ExactForWhatItAssumes) {
  for (const auto& times_s : std::vector<std::vector<double>>{
           {-0.02, -0.01, 0, 0.01, 0.02}, {0, 0.01, 0.02}, {-0.03, -0.01, 0}, {-0.01, 0, 0.04}}) {
    std::vector<TimedPlacement> placements;
    for (const double time_s : times_s) placements.push_back(At(time_s));
    const auto motion = FitLocalMotion(placements, kPivotMm);
    ASSERT_TRUE(motion);
    EXPECT_LT((motion->velocity_mm_s - kVelocity).norm(), 1e-8);
    EXPECT_LT((motion->acceleration_mm_s2 - kAcceleration).norm(), 1e-6);
    EXPECT_LT((motion->rate_rad_s - kRate).norm(), 1e-9);
    EXPECT_LT(motion->angular_acceleration_rad_s2.norm(), 1e-7);
    const Eigen::Vector3d p_mm(70, 80, -90);
    for (const double time_s : {-0.005, 0.0, 0.015}) {
      EXPECT_LT((motion->At(p_mm, time_s) - At(time_s).world_from_body * p_mm).norm(), 1e-9);
    }
  }
}

/// The textbook's weights: (1, −2, 1)/Δt² of three, (2, −1, −2, −1, 2)/(7 Δt²) of five.
TEST(FitLocalMotion, WeightsOfTheSecondDifference) {
  const auto three = FitLocalMotion({At(-0.1), At(0), At(0.1)}, kPivotMm);
  EXPECT_NEAR(three->middle_weight_s_2, -200, 1e-9);
  EXPECT_NEAR(three->other_weights2_s_4, 2e4, 1e-6);
  const auto five = FitLocalMotion({At(0), At(-0.2), At(-0.1), At(0.1), At(0.2)}, kPivotMm);
  EXPECT_NEAR(five->middle_weight_s_2, -200.0 / 7, 1e-9);
  EXPECT_NEAR(five->other_weights2_s_4, 1e4 * (4 + 1 + 1 + 4) / 49, 1e-6);
}

TEST(FitLocalMotion, NothingToTell) {
  EXPECT_FALSE(FitLocalMotion({At(0), At(0.1)}, kPivotMm));
  EXPECT_FALSE(FitLocalMotion({At(-0.1), At(0.1), At(0.2)}, kPivotMm));  // not the middle one
  EXPECT_FALSE(FitLocalMotion({At(-1), At(0), At(1)}, kPivotMm));        // turns by 2.3 rad
}

}  // namespace
}  // namespace stereomotion::testing
