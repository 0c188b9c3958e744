#include <gtest/gtest.h>

#include <cmath>

#include "stereomotion/geometry/so3.h"
#include "stereomotion/motion/spin_center.h"
#include "tests/support/motion_scene.h"
#include "tests/support/statistics.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

constexpr double kPsd_mm2_s3 = 2e4;

/// Moves a scene's noisy poses so that the centre follows a path of white acceleration: exactly the
/// model's. Returns the states (position, velocity) of every frame.
std::vector<Vector6d> Wander(const testing::MotionScene& scene, std::mt19937_64& rng,
                             MotionData& data) {
  std::vector<Vector6d> states;
  Vector6d state = Vector6d::Zero();
  for (std::size_t i = 0; i < data.frames.size(); ++i) {
    if (i > 0) {
      const double dt = scene.truth[i].time_s - scene.truth[i - 1].time_s;
      Eigen::Matrix2d q;
      q << dt * dt * dt / 3, dt * dt / 2, dt * dt / 2, dt;
      const Eigen::Matrix2d root = (kPsd_mm2_s3 * q).llt().matrixL();
      for (int axis = 0; axis < 3; ++axis) {
        const Eigen::Vector2d kick = root * testing::NormalVector<2>(rng);
        state[axis] += dt * state[axis + 3] + kick[0];
        state[axis + 3] += kick[1];
      }
    }
    states.push_back(state);
    states.back().head<3>() += scene.truth[i].center_mm;
    states.back().tail<3>() += scene.truth[i].velocity_mm_s;
    data.frames[i].pose.world_from_body.translation_mm += state.head<3>();
  }
  return states;
}

SpinCenterOptions FreeOptions() {
  SpinCenterOptions options;
  options.law = PathLaw::kFree;
  options.path_psd_mm2_s3 = kPsd_mm2_s3;
  return options;
}

TEST(FreePath, NoNoiseDensityNoCentre) {
  auto rng = testing::MakeTestRng();
  const auto scene = testing::MakeMotionScene(testing::FixedMotion(), rng);
  SpinCenterOptions options;
  options.law = PathLaw::kFree;
  EXPECT_FALSE(FindSpinCenter(scene.exact, options).center);
}

TEST(FreePath, ExactDataOfAStraightPath) {
  auto rng = testing::MakeTestRng();
  const auto plan = testing::UniformMotion();
  auto scene = testing::MakeMotionScene(plan, rng);
  scene.exact.frames[6].pose.measured = false;
  const auto result = FindSpinCenter(scene.exact, FreeOptions());
  ASSERT_TRUE(result.center) << result.verdict;
  EXPECT_LT((result.center->in_body_mm - plan.center_in_body_mm).norm(), 1e-5);
  for (std::size_t i = 0; i < scene.truth.size(); ++i) {
    EXPECT_LT((result.center->states[i].position_mm - scene.truth[i].center_mm).norm(), 1e-5);
    EXPECT_LT((result.center->states[i].velocity_mm_s - scene.truth[i].velocity_mm_s).norm(), 1e-3);
  }
}

/// A tiny density holds the path as straight as the uniform law does.
TEST(FreePath, NoAccelerationIsTheUniformLaw) {
  auto rng = testing::MakeTestRng();
  const auto scene = testing::MakeMotionScene(testing::UniformMotion(), rng);
  const MotionData data = testing::PosesOnly(testing::Observed(scene, rng));
  SpinCenterOptions options = FreeOptions();
  options.path_psd_mm2_s3 = 1e-9;
  const auto free = FindSpinCenter(data, options);
  options.law = PathLaw::kUniform;
  const auto uniform = FindSpinCenter(data, options);
  ASSERT_TRUE(free.center && uniform.center);
  const double sigma_mm = std::sqrt(uniform.center->covariance_mm2.trace());
  EXPECT_LT((free.center->in_body_mm - uniform.center->in_body_mm).norm(), 0.01 * sigma_mm);
  EXPECT_TRUE(free.center->covariance_mm2.isApprox(uniform.center->covariance_mm2, 0.02));
  EXPECT_TRUE((free.center->states[3].covariance.topLeftCorner<6, 6>().isApprox(
      uniform.center->states[3].covariance.topLeftCorner<6, 6>(), 0.02)));
}

TEST(FreePath, CovarianceIsTheSpread) {
  constexpr int kRepetitions = 150, kTests = 2;
  auto rng = testing::MakeTestRng();
  const auto plan = testing::FixedMotion();
  const auto scene = testing::MakeMotionScene(plan, rng);
  testing::ErrorStatistics centers, states;
  for (int i = 0; i < kRepetitions; ++i) {
    MotionData data = testing::PosesOnly(testing::Observed(scene, rng));
    const auto truth = Wander(scene, rng, data);
    const auto result = FindSpinCenter(data, FreeOptions());
    ASSERT_TRUE(result.center);
    centers.Add(result.center->in_body_mm - plan.center_in_body_mm, result.center->covariance_mm2);
    const CenterState& state = result.center->states[4];
    Vector6d error;
    error << state.position_mm, state.velocity_mm_s;
    states.Add(error - truth[4], state.covariance.topLeftCorner<6, 6>());
  }
  EXPECT_TRUE(testing::IsConsistent(centers, testing::FamilyZ(kTests)));
  EXPECT_TRUE(testing::IsConsistent(states, testing::FamilyZ(kTests)));
}

}  // namespace
}  // namespace stereomotion
