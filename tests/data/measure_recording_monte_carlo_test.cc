#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include "stereomotion/geometry/so3.h"
#include "stereomotion/pipeline/measure.h"
#include "tests/simulation/test_scenario.h"
#include "tests/support/center_bound.h"
#include "tests/support/recording_score.h"
#include "tests/support/simulated_pairs.h"
#include "tests/support/statistics.h"

namespace stereomotion::testing {
namespace {

struct Condition {
  const char* name;
  /// The position's error lies mostly along one direction, so that its RMSE over n frames is known
  /// to some 0.6 / √n only.
  std::int64_t frames;
  double ball_level, background_level, full_well_e, read_e;
};

void PrintTo(const Condition& condition, std::ostream* out) { *out << condition.name; }

/// A body of two rods, 9 px balls in images of 384 × 320 px, all of them visible and apart.
Scenario MakeScenario(const Condition& condition) {
  Scenario scenario = MakeTestScenario();
  for (RigCamera& camera : scenario.rig.cameras) {
    camera.width_px = 384;
    camera.height_px = 320;
    camera.model.cx_px += 32;
    camera.model.cy_px += 32;
  }
  scenario.body.rods[0].balls_in_body_mm = {
      {-110, -50, 0}, {-70, -50, 0}, {-20, -50, 0}, {45, -50, 0}, {105, -50, 0}};
  scenario.body.rods[1].balls_in_body_mm = {
      {-100, 70, 60}, {-40, 55, 60}, {5, 43.75, 60}, {45, 33.75, 60}, {115, 16.25, 60}};
  scenario.light.ball_level = condition.ball_level;
  scenario.light.background_level = condition.background_level;
  scenario.sensor.full_well_e = condition.full_well_e;
  scenario.sensor.read_e = condition.read_e;
  scenario.frames = static_cast<int>(condition.frames);
  return scenario;
}

/// The body swings about all axes and stands still during each exposure.
Scenario ScenarioAt(const Scenario& scenario, std::int64_t frame) {
  const double t_s = TimeOfFrame(scenario, 0, frame).true_s;
  Scenario still = scenario;
  BodyMotion& motion = still.motion;
  motion = {};
  motion.world_from_body = ExpSO3(
      {0.15 * std::sin(1.7 * t_s), 0.2 * std::sin(1.1 * t_s + 1), 0.25 * std::sin(2.3 * t_s + 2)});
  motion.center_in_world_mm = {15 * std::sin(1.9 * t_s), 12 * std::sin(1.3 * t_s + 1),
                               40 * std::sin(0.7 * t_s)};
  return still;
}

Truth TruthOf(const Scenario& scenario) {
  Truth truth;
  for (std::int64_t frame = 0; frame < scenario.frames; ++frame) {
    const Scenario still = ScenarioAt(scenario, frame);
    const double t_s = TimeOfFrame(still, 0, frame).true_s;
    TrueFrame& true_frame = truth[frame];
    true_frame.world_from_body = StateAt(still.motion, t_s).world_from_body;
    for (const int camera : {0, 1}) {
      for (const BallTruth& ball : BallTruths(still, camera, t_s)) {
        true_frame.balls[static_cast<std::size_t>(camera)].push_back(
            {ball.id, ball.p_in_world_mm, ball.center_px, ball.outline_px, ball.diameter_px,
             ball.visible, ball.inside});
      }
    }
  }
  return truth;
}

RecordingRun MeasureSimulated(const Scenario& scenario) {
  RecordingRun run;
  run.setup = {scenario.rig, 0, 1, {scenario.body}, {}, {}};
  run.truth = TruthOf(scenario);
  const SimulatedPairs source(
      scenario.frames, [&scenario](std::int64_t frame) { return ScenarioAt(scenario, frame); });
  run.summary = MeasureRecording(source, run.setup, {}, [&run](const PairMeasurement& measurement) {
    run.measurements.push_back(measurement);
    return true;
  });
  return run;
}

/// Root mean bounds over all frames, as `ErrorStatistics::rmse` sums errors.
struct PoseBound {
  double position_mm = 0;  ///< of the balls' centroid
  double turn_rad = 0;
};

PoseBound BoundOf(const Scenario& scenario, const Truth& truth) {
  // Between 8 and 11 px the bound is a smooth, nearly straight line.
  const double low_px2 = CenterBoundPx2(scenario, 8);
  const double mid_px2 = CenterBoundPx2(scenario, 9.5);
  const double high_px2 = CenterBoundPx2(scenario, 11);
  const auto variance_px2 = [&](double diameter_px) {
    const double x = (diameter_px - 9.5) / 1.5;
    return mid_px2 + x * (high_px2 - low_px2) / 2 + x * x * ((high_px2 + low_px2) / 2 - mid_px2);
  };
  double position_mm2 = 0;
  double turn_rad2 = 0;
  for (const auto& [frame, true_frame] : truth) {
    PoseEstimate bound;
    bound.world_from_body = true_frame.world_from_body;
    bound.covariance = PoseFisher(scenario, true_frame.world_from_body, variance_px2).inverse();
    turn_rad2 += bound.covariance.topLeftCorner<3, 3>().trace();
    position_mm2 += PositionCovariance(bound, BallCentroid(scenario.body)).trace();
  }
  const auto frames = static_cast<double>(truth.size());
  return {std::sqrt(position_mm2 / frames), std::sqrt(turn_rad2 / frames)};
}

class MeasureRecordingMonteCarlo : public ::testing::TestWithParam<Condition> {};

/// Images, noise learning, detection and pose together, as `track` runs them. 1 000 frames and
/// 20 000 centres; all bars are DESIGN.md's.
TEST_P(MeasureRecordingMonteCarlo, ErrorsAreAsStatedAndAtTheBound) {
  const Scenario scenario = MakeScenario(GetParam());
  const RecordingRun run = MeasureSimulated(scenario);
  const RecordingScore score = Score(run);
  const PoseBound bound = BoundOf(scenario, run.truth);
  ASSERT_EQ(score.clear_pairs, scenario.frames);
  EXPECT_EQ(score.poses, scenario.frames);
  EXPECT_EQ(run.summary.noise_left.origin, "learned");
  EXPECT_EQ(run.summary.noise_right.origin, "learned");
  EXPECT_GE(score.centers.samples(), 0.99 * score.shown_centers);
  for (const ErrorStatistics* errors : {&score.centers, &score.points, &score.poses6}) {
    EXPECT_GT(errors->nees_per_dof(), 0.95);
    EXPECT_LT(errors->nees_per_dof(), 1.05);
  }
  EXPECT_LE(score.centroid_mm.rmse(), 1.05 * bound.position_mm);
  EXPECT_LE(score.turn_rad.rmse(), 1.05 * bound.turn_rad);
  fmt::print("{}{}", ScoreHeader(), ScoreRow(GetParam().name, score));
  fmt::print("bounds: centre {:.5f} px, position {:.5f} mm, rotation {:.3g} rad\n",
             std::sqrt(CenterBoundPx2(scenario, 9)), bound.position_mm, bound.turn_rad);
  fmt::print("RMSE / bound: position {:.4f}, rotation {:.4f}\n",
             score.centroid_mm.rmse() / bound.position_mm, score.turn_rad.rmse() / bound.turn_rad);
  for (const NoiseRecord* noise : {&run.summary.noise_left, &run.summary.noise_right}) {
    fmt::print("noise learned: gain {:.3f} e/DN, read {:.3f} e; true {:.3f}, {:.3f}\n",
               noise->noise.gain_e_per_dn, noise->noise.read_e,
               scenario.sensor.noise().gain_e_per_dn, scenario.sensor.noise().read_e);
  }
}

std::string NameOf(const ::testing::TestParamInfo<Condition>& info) { return info.param.name; }

// Backgrounds at a whole grey value and at a half one: where the noise is smaller than the steps of
// the grey values, their rounding hides it in two different ways.
INSTANTIATE_TEST_SUITE_P(
    Conditions, MeasureRecordingMonteCarlo,
    ::testing::Values(Condition{"bright", 4000, 0.65, 0.06, 15000, 8},
                      Condition{"dark_background", 1000, 0.65, 4.0 / 255, 15000, 8},
                      Condition{"dark_background_between", 1000, 0.65, 4.5 / 255, 15000, 8},
                      Condition{"weak", 1000, 0.15, 0.015, 1500, 10}),
    NameOf);

}  // namespace
}  // namespace stereomotion::testing
