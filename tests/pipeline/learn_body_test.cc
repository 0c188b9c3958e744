#include "stereomotion/pipeline/learn_body.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <stdexcept>

#include "tests/simulation/test_scenario.h"
#include "tests/support/learned_body.h"
#include "tests/support/simulated_pairs.h"

namespace stereomotion::testing {
namespace {

constexpr std::int64_t kPairs = 8;

/// A scene of twice the size of the usual one, the body on its left.
Scenario MakeWideScenario() {
  Scenario scenario = MakeTestScenario();
  for (RigCamera& camera : scenario.rig.cameras) {
    camera.width_px = 640;
    camera.height_px = 400;
    camera.model.cx_px += 160;
    camera.model.cy_px += 72;
  }
  scenario.motion.center_in_world_mm = {-130, 10, 0};
  return scenario;
}

Body OtherBody() {
  return {"other",
          {{"A", 14, {{-80, -20, 0}, {-35, -20, 0}, {-5, -20, 0}, {50, -20, 0}, {80, -20, 0}}, 0},
           {"B", 14, {{10, 0, 25}, {10, 25, 25}, {10, 60, 25}, {10, 85, 25}, {10, 120, 25}}, 0}},
          {}};
}

/// A body is shown by bright balls where it is at mid-exposure.
void ShowOtherBody(const BodyMotion& motion, double time_s, Scenario& scenario) {
  const Rigid3 world_from_body = StateAt(motion, time_s).world_from_body;
  for (const Rod& rod : OtherBody().rods) {
    for (const Eigen::Vector3d& ball : rod.balls_in_body_mm) {
      scenario.false_balls.push_back({world_from_body * ball, rod.ball_diameter_mm});
    }
  }
}

BodyMotion OtherMotion() {
  BodyMotion motion;
  motion.center_in_world_mm = {150, -20, 30};
  motion.spin_in_world_rad_s = {0.2, -1.5, 0.4};
  motion.velocity_in_world_mm_s = {-30, 60, 0};
  return motion;
}

/// A few balls that rest.
void ShowBackground(Scenario& scenario) {
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(-280, -150, 50), Eigen::Vector3d(-40, 140, 80),
                                   Eigen::Vector3d(60, -170, 20), Eigen::Vector3d(280, 150, 90),
                                   Eigen::Vector3d(300, -100, 0)}) {
    scenario.false_balls.push_back({p, 12});
  }
}

/// Renders pairs once; they are read twice.
StoredPairs Render(std::int64_t count, const SimulatedPairs::ScenarioAt& scenario_at) {
  std::vector<FramePair> pairs(static_cast<std::size_t>(count));
  for (std::int64_t i = 0; i < count; ++i) {
    RenderPair(scenario_at(i), i, pairs[static_cast<std::size_t>(i)]);
  }
  return StoredPairs(std::move(pairs));
}

MeasureSetup SetupOf(const Scenario& scenario) {
  MeasureSetup setup;
  setup.rig = scenario.rig;
  for (RigCamera& camera : setup.rig.cameras) camera.noise = scenario.sensor.noise();
  return setup;
}

void ExpectLearned(const Body& learned, const Body& truth) {
  ASSERT_EQ(learned.rods.size(), truth.rods.size());
  for (const Rod& rod : learned.rods) {
    EXPECT_EQ(rod.balls_in_body_mm.size(), 5U);
    EXPECT_NEAR(rod.ball_diameter_mm, 14, 0.02 * 14);  // far more than perspective needs
  }
  const auto ordered = InOrderOf(learned, truth);
  ASSERT_TRUE(ordered);
  ErrorStatistics errors;
  AddInGauge(learned, *ordered, errors);
  EXPECT_TRUE(IsConsistent(errors, FamilyZ(4)));
}

TEST(LearnBodies, OneBodyBeforeABackground) {
  Scenario scenario = MakeWideScenario();
  ShowBackground(scenario);
  const StoredPairs pairs = Render(kPairs, [&](std::int64_t) { return scenario; });
  const auto learned = LearnBodies(pairs, SetupOf(scenario), {});
  ASSERT_TRUE(learned);
  ASSERT_EQ(learned->bodies.size(), 1U);
  EXPECT_TRUE(learned->warnings.empty());
  const Body& body = learned->bodies[0];
  EXPECT_EQ(body.name, "body");
  EXPECT_EQ(body.rods[0].name, "A");
  ExpectLearned(body, scenario.body);
  EXPECT_LT(BallColumns(body).rowwise().mean().norm(), 1e-9);  // the origin is the balls' centroid
  // Axes as the world's in the first pair, to the pose's noise.
  const Rigid3 learned_from_truth = LearnedFromTruth(body, *InOrderOf(body, scenario.body));
  const Rigid3 first = StateAt(scenario.motion, 0).world_from_body;
  EXPECT_LT(learned_from_truth.rotation.angularDistance(first.rotation), 0.01);
}

TEST(LearnBodies, TwoBodiesAreToldApart) {
  const Scenario scenario = MakeWideScenario();
  const StoredPairs pairs = Render(kPairs, [&](std::int64_t frame) {
    Scenario both = scenario;
    ShowOtherBody(OtherMotion(), TimeOfFrame(scenario, 0, frame).true_s, both);
    ShowBackground(both);
    return both;
  });
  const auto learned = LearnBodies(pairs, SetupOf(scenario), {});
  ASSERT_TRUE(learned);
  ASSERT_EQ(learned->bodies.size(), 2U);
  EXPECT_EQ(learned->bodies[0].name, "body1");
  const bool swapped = !InOrderOf(learned->bodies[0], scenario.body);
  ExpectLearned(learned->bodies[swapped ? 1 : 0], scenario.body);
  ExpectLearned(learned->bodies[swapped ? 0 : 1], OtherBody());
}

TEST(LearnBodies, ARodAlone) {
  Scenario scenario = MakeWideScenario();
  scenario.body.rods.resize(1);
  ShowBackground(scenario);
  const StoredPairs pairs = Render(kPairs, [&](std::int64_t) { return scenario; });
  const auto learned = LearnBodies(pairs, SetupOf(scenario), {});
  ASSERT_TRUE(learned);
  ASSERT_EQ(learned->bodies.size(), 1U);
  EXPECT_TRUE(learned->warnings.empty());
  const Body& body = learned->bodies[0];
  ASSERT_EQ(body.rods.size(), 1U);
  const auto ordered = InOrderOf(body, scenario.body);
  ASSERT_TRUE(ordered);
  // Places along the rod, from their mean; the covariance has no other directions.
  const Eigen::Matrix3Xd is = BallColumns(body), truth = BallColumns(*ordered);
  const Eigen::Vector3d along = (is.col(4) - is.col(0)).normalized();
  const Eigen::Vector3d true_along = (truth.col(4) - truth.col(0)).normalized();
  const Eigen::VectorXd true_mm =
      (truth.colwise() - truth.rowwise().mean().eval()).transpose() * true_along;
  const Eigen::VectorXd error_mm = is.transpose() * along - true_mm;
  Eigen::MatrixXd to_places = Eigen::MatrixXd::Zero(5, 15);
  for (Eigen::Index i = 0; i < 5; ++i) to_places.block<1, 3>(i, 3 * i) = along.transpose();
  const Eigen::MatrixXd covariance_mm2 = to_places * body.covariance_mm2 * to_places.transpose();
  EXPECT_NEAR(covariance_mm2.trace(), body.covariance_mm2.trace(),
              1e-9 * body.covariance_mm2.trace());
  ErrorStatistics errors;
  const Eigen::Index free = 4;
  errors.Add(error_mm.head(free), covariance_mm2.topLeftCorner(free, free));
  EXPECT_TRUE(IsConsistent(errors, FamilyZ(4)));
}

TEST(LearnBodies, SameOnAnyNumberOfThreads) {
  const Scenario scenario = MakeWideScenario();
  const StoredPairs pairs = Render(kPairs, [&](std::int64_t) { return scenario; });
  std::vector<Body> bodies;
  for (const int threads : {1, 2}) {
    LearnBodyOptions options;
    options.measure.threads = threads;
    std::int64_t steps = 0;
    const auto learned = LearnBodies(pairs, SetupOf(scenario), options, nullptr, [&] { ++steps; });
    ASSERT_TRUE(learned);
    EXPECT_EQ(steps, 2 * kPairs);  // both rounds
    bodies.push_back(learned->bodies.at(0));
  }
  for (const Body& body : bodies) {
    EXPECT_EQ(BallColumns(body), BallColumns(bodies[0]));
    EXPECT_EQ(body.covariance_mm2, bodies[0].covariance_mm2);
    EXPECT_EQ(body.rods[0].ball_diameter_mm, bodies[0].rods[0].ball_diameter_mm);
  }
}

TEST(LearnBodies, NothingMoves) {
  Scenario scenario = MakeWideScenario();
  scenario.motion.spin_in_world_rad_s.setZero();
  const StoredPairs resting = Render(4, [&](std::int64_t) { return scenario; });
  const auto learned = LearnBodies(resting, SetupOf(scenario), {});
  ASSERT_TRUE(learned);
  EXPECT_EQ(CountBalls(learned->bodies.at(0)), 10U);
  ASSERT_FALSE(learned->warnings.empty());
  EXPECT_NE(learned->warnings[0].find("nothing moves"), std::string::npos);

  Scenario background = scenario;
  background.motion.center_in_world_mm = {0, 0, -5000};  // behind the cameras
  ShowBackground(background);
  const StoredPairs empty = Render(4, [&](std::int64_t) { return background; });
  const auto failure = LearnBodies(empty, SetupOf(scenario), {});
  ASSERT_FALSE(failure);
  EXPECT_EQ(failure.error(), LearnBodyFailure::kNoMotion);
}

TEST(LearnBodies, NoAnswer) {
  Scenario scenario = MakeWideScenario();
  scenario.motion.center_in_world_mm = {0, 0, -5000};  // behind the cameras
  const auto error_of = [&](const Scenario& seen, bool stopped) {
    const std::atomic<bool> stop = stopped;
    const StoredPairs pairs = Render(4, [&](std::int64_t frame) {
      Scenario now = seen;  // balls of no body: each goes its own way
      for (std::size_t i = 0; i < now.false_balls.size(); ++i) {
        now.false_balls[i].p_in_world_mm.x() += 11.0 * static_cast<double>(i * i * frame);
        now.false_balls[i].p_in_world_mm.x() =
            std::remainder(now.false_balls[i].p_in_world_mm.x(), 500);
      }
      return now;
    });
    const auto learned = LearnBodies(pairs, SetupOf(scenario), {}, &stop);
    EXPECT_FALSE(learned);
    return learned.error();
  };
  EXPECT_EQ(error_of(scenario, true), LearnBodyFailure::kInterrupted);
  EXPECT_EQ(error_of(scenario, false), LearnBodyFailure::kTooFewBalls);
  ShowBackground(scenario);
  EXPECT_EQ(error_of(scenario, false), LearnBodyFailure::kNoGroup);
}

TEST(LearnBodies, WrongUse) {
  MeasureSetup setup = SetupOf(MakeWideScenario());
  setup.right_camera = 2;
  EXPECT_THROW(LearnBodies(StoredPairs({}), setup, {}), std::invalid_argument);
}

}  // namespace
}  // namespace stereomotion::testing
