#include "stereomotion/simulation/scenario.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "stereomotion/geometry/so3.h"
#include "tests/simulation/test_scenario.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::MakeTestRng;
using testing::MakeTestScenario;
using testing::NormalVector;

BodyMotion RandomMotion(std::mt19937_64& rng) {
  BodyMotion motion;
  motion.center_in_body_mm = 30 * NormalVector<3>(rng);
  motion.center_in_world_mm = 50 * NormalVector<3>(rng);
  motion.world_from_body = ExpSO3(NormalVector<3>(rng));
  motion.spin_in_world_rad_s = 3 * NormalVector<3>(rng);
  motion.precession_in_world_rad_s = 2 * NormalVector<3>(rng);
  motion.velocity_in_world_mm_s = 40 * NormalVector<3>(rng);
  return motion;
}

TEST(StateAt, QuarterTurnAboutAFixedCentre) {
  BodyMotion motion;
  motion.center_in_body_mm = {10, 0, 0};
  motion.center_in_world_mm = {1, 2, 3};
  motion.spin_in_world_rad_s = {0, 0, M_PI};
  const BodyState state = StateAt(motion, 0.5);
  EXPECT_LT((state.world_from_body * Eigen::Vector3d(10, 5, 0) - Eigen::Vector3d(-4, 2, 3)).norm(),
            1e-12);
}

TEST(StateAt, SpinCentreFollowsItsLaw) {
  auto rng = MakeTestRng();
  const BodyMotion motion = RandomMotion(rng);
  for (const double time_s : {-0.4, 0.0, 1.7}) {
    const BodyState state = StateAt(motion, time_s);
    EXPECT_LT((state.world_from_body * motion.center_in_body_mm - state.center_in_world_mm).norm(),
              1e-10);
    EXPECT_LT((state.center_in_world_mm - motion.center_in_world_mm -
               time_s * motion.velocity_in_world_mm_s)
                  .norm(),
              1e-10);
    EXPECT_GE(state.world_from_body.rotation.w(), 0);
  }
}

TEST(StateAt, AngularVelocityIsTheDerivativeOfTheRotation) {
  auto rng = MakeTestRng();
  const BodyMotion motion = RandomMotion(rng);
  constexpr double kStep_s = 1e-5;
  for (const double time_s : {0.0, 0.3, 2.1}) {
    const BodyState before = StateAt(motion, time_s - kStep_s);
    const BodyState after = StateAt(motion, time_s + kStep_s);
    const Eigen::Vector3d turned_rad =
        LogSO3(after.world_from_body.rotation * before.world_from_body.rotation.conjugate());
    EXPECT_LT((turned_rad / (2 * kStep_s) - StateAt(motion, time_s).angular_velocity_in_world_rad_s)
                  .norm(),
              1e-6);
  }
}

TEST(TimeOfFrame, LagMovesTheExposureAndOnlyIfReportedTheStamp) {
  Scenario scenario = MakeTestScenario();
  scenario.fps = 25;
  scenario.lag_s = 0.006;
  EXPECT_DOUBLE_EQ(TimeOfFrame(scenario, 0, 5).true_s, 0.2);
  EXPECT_DOUBLE_EQ(TimeOfFrame(scenario, 1, 5).true_s, 0.206);
  EXPECT_EQ(TimeOfFrame(scenario, 1, 5).timestamp_ns, 1200000000);
  scenario.lag_reported = true;
  EXPECT_EQ(TimeOfFrame(scenario, 0, 5).timestamp_ns, 1200000000);
  EXPECT_EQ(TimeOfFrame(scenario, 1, 5).timestamp_ns, 1206000000);
}

TEST(CheckScenario, NamesWhatIsWrong) {
  const auto rejects = [](void (*spoil)(Scenario&)) {
    Scenario scenario = MakeTestScenario();
    spoil(scenario);
    EXPECT_THROW(CheckScenario(scenario), std::invalid_argument);
  };
  EXPECT_NO_THROW(CheckScenario(MakeTestScenario()));
  rejects([](Scenario& s) { s.rig.cameras.pop_back(); });
  rejects([](Scenario& s) { s.rig.cameras[0].width_px = 0; });
  rejects([](Scenario& s) { s.body.rods.clear(); });
  rejects([](Scenario& s) { s.body.rods[0].ball_diameter_mm = 0; });
  rejects([](Scenario& s) { s.motion.world_from_body.coeffs() *= 2; });
  rejects([](Scenario& s) { s.motion.velocity_in_world_mm_s.x() = NAN; });
  rejects([](Scenario& s) { s.light.ball_level = 0; });
  rejects([](Scenario& s) { s.light.blur_px = -1; });
  rejects([](Scenario& s) { s.light.limb_falloff = 1.5; });
  rejects([](Scenario& s) { s.light.ball_slope = {1.5, 1}; });
  rejects([](Scenario& s) { s.sensor.bits = 7; });
  rejects([](Scenario& s) { s.sensor.full_well_e = 0; });
  rejects([](Scenario& s) { s.sensor.exposure_s = -1; });
  rejects([](Scenario& s) { s.false_balls.emplace_back(); });
  rejects([](Scenario& s) { s.frames = 0; });
  rejects([](Scenario& s) { s.fps = 0; });
  rejects([](Scenario& s) { s.lag_s = INFINITY; });
}

}  // namespace
}  // namespace stereomotion
