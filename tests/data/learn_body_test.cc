#include "stereomotion/pipeline/learn_body.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <ostream>

#include "stereomotion/capture/recording.h"
#include "stereomotion/geometry/so3.h"
#include "stereomotion/io/body_file.h"
#include "stereomotion/io/rig_file.h"
#include "tests/support/learned_body.h"
#include "tests/support/recording_run.h"
#include "tests/support/recording_score.h"

namespace stereomotion::testing {
namespace {

namespace fs = std::filesystem;

/// Recordings whose learned bodies are judged: one family of tests.
constexpr int kFamily = 11;

/// A recording, and the rig file of it that is believed.
struct Case {
  const char* recording;
  const char* rig = "rig.yaml";
  const char* name = recording;
};

void PrintTo(const Case& from, std::ostream* out) { *out << from.name; }

/// Holds what a recording taught, and what is true of it.
struct Lesson {
  MeasureSetup setup;
  Body truth;
  std::unique_ptr<PairSource> source;
  Expected<LearnedBodies, LearnBodyFailure> learned = Unexpected{LearnBodyFailure::kNoGroup};
};

Lesson Learn(const Case& from) {
  const fs::path recording = SharedData() / "rendered" / from.recording;
  Lesson lesson;
  lesson.setup.rig = ReadRig(recording / from.rig);
  lesson.truth = ReadBody(recording / "body.yaml");
  lesson.source = OpenRecording(recording / "cam0", recording / "cam1");
  lesson.learned = LearnBodies(*lesson.source, lesson.setup, {});
  return lesson;
}

/// Spread of a run's poses about the truth, of the balls' centroid and of the rotation, less a
/// constant offset of the body's frame: a learned body's frame is nobody's to know, and who is
/// given a body loses nothing by it.
struct MotionError {
  double position_mm = 0, rotation_rad = 0;
  int poses = 0;
};

MotionError SpreadOf(const std::vector<Vector6d>& errors) {
  Vector6d mean = Vector6d::Zero();
  for (const Vector6d& error : errors) mean += error / static_cast<double>(errors.size());
  Vector6d sum2 = Vector6d::Zero();
  for (const Vector6d& error : errors) sum2 += (error - mean).cwiseAbs2();
  const Vector6d variance = sum2 / static_cast<double>(errors.size() - 1);
  return {std::sqrt(variance.tail<3>().sum()), std::sqrt(variance.head<3>().sum()),
          static_cast<int>(errors.size())};
}

MotionError ErrorOf(const Lesson& lesson, const Body& body, const Rigid3& body_from_truth,
                    const Truth& truth) {
  MeasureSetup setup = lesson.setup;
  setup.bodies = {body};
  const Eigen::Vector3d centroid_mm = BallCentroid(lesson.truth);
  std::vector<Vector6d> errors;  // in the body's axes
  const auto sink = [&](const PairMeasurement& measurement) {
    if (!measurement.pose) return true;
    const Rigid3& is = truth.at(measurement.frame).world_from_body;
    const Rigid3 off = is.Inverse() * (measurement.pose->world_from_body * body_from_truth);
    errors.emplace_back();
    errors.back() << LogSO3(off.rotation), off * centroid_mm - centroid_mm;
    return true;
  };
  MeasureRecording(*lesson.source, setup, {}, sink);
  return SpreadOf(errors);
}

/// All balls found, in rods of five, and where they are by the covariance that the body states.
class LearnRecordingTest : public ::testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    if (!fs::exists(SharedData() / "rendered")) GTEST_SKIP() << "no shared recordings";
  }
};

TEST_P(LearnRecordingTest, BodyIsConsistentWithTheTruth) {
  const Lesson lesson = Learn(GetParam());
  ASSERT_TRUE(lesson.learned);
  for (const std::string& warning : lesson.learned->warnings) fmt::print("warning: {}\n", warning);
  ASSERT_EQ(lesson.learned->bodies.size(), 1U);
  const Body& body = lesson.learned->bodies[0];
  EXPECT_EQ(CountBalls(body), CountBalls(lesson.truth));
  for (const Rod& rod : body.rods) EXPECT_EQ(rod.balls_in_body_mm.size(), 5U);
  const auto truth = InOrderOf(body, lesson.truth);
  ASSERT_TRUE(truth);
  ErrorStatistics errors;
  AddInGauge(body, *truth, errors);
  fmt::print("{}: {} balls, diameter {:.2f} mm, largest sigma {:.4f} mm, NEES/dof {:.2f} of {}\n",
             GetParam().name, CountBalls(body), body.rods[0].ball_diameter_mm,
             LargestBallSigmaMm(body), errors.nees_per_dof(), errors.dof());
  EXPECT_TRUE(IsConsistent(errors, FamilyZ(kFamily)));
}

INSTANTIATE_TEST_SUITE_P(
    Recordings, LearnRecordingTest,
    ::testing::Values(Case{"wide_precession"}, Case{"spin_fixed"}, Case{"easy"}, Case{"easy_rod"},
                      Case{"screw"}, Case{"clutter"}, Case{"overlap"}, Case{"weak_light"},
                      Case{"occlusion"},
                      // A rig with errors as it states them: they are in the body's covariance.
                      Case{"screw", "rig_calibrated.yaml", "screw_rig_calibrated"},
                      // The lag is found, and its uncertainty is in the body's covariance.
                      Case{"unsync"}),
    [](const auto& param) { return std::string(param.param.name); });

/// Motion measured with the learned body against motion measured with the given one, each less the
/// constant offset of its body's frame (`MotionError`).
class LearnedMotionTest : public LearnRecordingTest {};

TEST_P(LearnedMotionTest, IsAsAccurateAsWithTheGivenBody) {
  const Lesson lesson = Learn(GetParam());
  ASSERT_TRUE(lesson.learned);
  const Body& body = lesson.learned->bodies.at(0);
  const auto ordered = InOrderOf(body, lesson.truth);
  ASSERT_TRUE(ordered);
  const Truth truth =
      ReadTruth(SharedData() / "rendered" / GetParam().recording, lesson.truth, {"cam0", "cam1"});
  const MotionError given = ErrorOf(lesson, lesson.truth, {}, truth);
  const MotionError learned = ErrorOf(lesson, body, LearnedFromTruth(body, *ordered), truth);
  fmt::print("{}: RMSE given {:.5f} mm {:.6f} rad, learned {:.5f} mm {:.6f} rad\n", GetParam().name,
             given.position_mm, given.rotation_rad, learned.position_mm, learned.rotation_rad);
  EXPECT_EQ(learned.poses, given.poses);
  EXPECT_LE(learned.position_mm, 1.1 * given.position_mm);
  EXPECT_LE(learned.rotation_rad, 1.1 * given.rotation_rad);
}

INSTANTIATE_TEST_SUITE_P(Recordings, LearnedMotionTest,
                         ::testing::Values(Case{"wide_precession"}, Case{"spin_fixed"}),
                         [](const auto& param) { return std::string(param.param.name); });

}  // namespace
}  // namespace stereomotion::testing
