#include "tests/support/motion_scene.h"

#include <gtest/gtest.h>

#include "stereomotion/geometry/so3.h"
#include "tests/support/statistics.h"
#include "tests/support/test_rng.h"

namespace stereomotion::testing {
namespace {

std::vector<MotionPlan> AllMotions() {
  return {FixedMotion(), UniformMotion(),    AcceleratedMotion(), PrecessionMotion(),
          ScrewMotion(), SmallRangeMotion(), SingleAxisMotion(),  RandomMotion()};
}

TEST(MotionScene, DerivativesAreThoseOfThePoses) {
  for (MotionPlan plan : AllMotions()) {
    // Central differences over ± 1 step of a fine grid: error (h²/6) · third derivative.
    plan.rate_hz *= 1000;
    const double duration_s = 0.23;
    plan.frames = static_cast<int>(duration_s * plan.rate_hz) + 1;
    const auto truth = TrueMotion(plan);
    const Eigen::Vector3d point_mm(100, -50, 70);
    for (std::size_t i = 1; i + 1 < truth.size(); i += 997) {
      const double dt_s = truth[i + 1].time_s - truth[i - 1].time_s;
      const auto step =
          PerturbationBetween(truth[i - 1].world_from_body, truth[i + 1].world_from_body);
      EXPECT_LT((step.head<3>() / dt_s - truth[i].omega_rad_s).norm(), 1e-6);
      EXPECT_LT(
          ((truth[i + 1].omega_rad_s - truth[i - 1].omega_rad_s) / dt_s - truth[i].alpha_rad_s2)
              .norm(),
          1e-4);
      const Eigen::Vector3d velocity_mm_s =
          (truth[i + 1].world_from_body * point_mm - truth[i - 1].world_from_body * point_mm) /
          dt_s;
      EXPECT_LT((velocity_mm_s - truth[i].VelocityOf(point_mm)).norm(), 1e-4);
      const Eigen::Vector3d acceleration_mm_s2 =
          (truth[i + 1].VelocityOf(point_mm) - truth[i - 1].VelocityOf(point_mm)) / dt_s;
      EXPECT_LT((acceleration_mm_s2 - truth[i].AccelerationOf(point_mm)).norm(), 1e-2);
      EXPECT_LT((truth[i].world_from_body * plan.center_in_body_mm - truth[i].center_mm).norm(),
                1e-9);
    }
  }
}

TEST(MotionScene, PosesSpreadAsStated) {
  std::mt19937_64 rng = MakeTestRng();
  for (const bool with_space_points : {false, true}) {
    SceneOptions options;
    options.with_space_points = with_space_points;
    const MotionScene scene = MakeMotionScene(FixedMotion(), rng, options);
    ErrorStatistics errors;
    for (int repetition = 0; repetition < 30; ++repetition) {
      const MotionData data = Observed(scene, rng);
      for (std::size_t i = 0; i < data.frames.size(); ++i) {
        errors.Add(PerturbationBetween(scene.truth[i].world_from_body,
                                       data.frames[i].pose.world_from_body),
                   data.frames[i].pose.covariance);
      }
    }
    EXPECT_TRUE(IsConsistent(errors, FamilyZ(2)));
  }
}

TEST(MotionScene, EveryMotionStaysInTheImages) {
  std::mt19937_64 rng = MakeTestRng();
  for (const MotionPlan& plan : AllMotions()) EXPECT_NO_THROW(MakeMotionScene(plan, rng));
}

}  // namespace
}  // namespace stereomotion::testing
