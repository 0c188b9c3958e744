#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "tests/support/recording_run.h"
#include "tests/support/recording_score.h"
#include "tests/support/statistics.h"

namespace stereomotion::testing {
namespace {

namespace fs = std::filesystem;

constexpr double kDegree = M_PI / 180;

/// Two-sided tests in this program: three NEES on each of seven recordings, four biases on two.
constexpr int kTests = 7 * 3 + 2 * 4;

/// The definition of a wrong pose.
constexpr double kWrongMm = 0.5;
constexpr double kWrongRad = 0.2 * kDegree;

struct Evaluation {
  RecordingRun run;
  RecordingScore score;
};

std::map<std::string, Evaluation>& Evaluations() {
  static std::map<std::string, Evaluation> evaluations;
  return evaluations;
}

/// Measures a recording once a program; null where it is not on this machine.
const Evaluation* Evaluate(const std::string& name, const std::string& rig_file = "rig.yaml") {
  const fs::path folder = name == "demo" ? DemoRecording() : SharedData() / "rendered" / name;
  const std::string key = rig_file == "rig.yaml" ? name : name + "+" + rig_file;
  const auto known = Evaluations().find(key);
  if (known != Evaluations().end()) return &known->second;
  if (!fs::exists(folder)) return nullptr;
  Evaluation evaluation;
  evaluation.run = MeasureFolder(folder, rig_file);
  evaluation.score = Score(evaluation.run);
  return &Evaluations().emplace(key, std::move(evaluation)).first->second;
}

/// Prints the figures of every recording that the program has measured.
class FiguresTable : public ::testing::Environment {
 public:
  void TearDown() override {
    if (Evaluations().empty()) return;
    fmt::print("\n{}", ScoreHeader());
    for (const auto& [name, evaluation] : Evaluations()) {
      fmt::print("{}", ScoreRow(name, evaluation.score));
    }
  }
};
const ::testing::Environment* const kFiguresTable =
    ::testing::AddGlobalTestEnvironment(new FiguresTable);

std::string NameOf(const ::testing::TestParamInfo<const char*>& info) { return info.param; }

class RecordingTest : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    evaluation_ = Evaluate(GetParam());
    if (evaluation_ == nullptr) {
      GTEST_SKIP() << (SharedData() / "rendered" / GetParam()).string()
                   << " is not here (set STEREOMOTION_SHARED_DATA)";
    }
  }
  [[nodiscard]] const RecordingScore& score() const { return evaluation_->score; }

  const Evaluation* evaluation_ = nullptr;
};

class PosedRecordingTest : public RecordingTest {};

TEST_P(PosedRecordingTest, ClearPairsHavePoses) {
  ASSERT_GT(score().clear_pairs, 0);
  EXPECT_GE(score().clear_poses, 0.99 * score().clear_pairs);
}

TEST_P(PosedRecordingTest, NoWrongPoseIsCalledOk) {
  ASSERT_GT(score().poses, 0);
  EXPECT_LE(score().worst_origin_mm, kWrongMm);
  EXPECT_LE(score().worst_centroid_mm, kWrongMm);
  EXPECT_LE(score().worst_turn_rad, kWrongRad);
}

INSTANTIATE_TEST_SUITE_P(Recordings, PosedRecordingTest,
                         ::testing::Values("demo", "easy", "spin_fixed", "wide_precession", "screw",
                                           "weak_light", "clutter", "occlusion", "fast_blur"),
                         NameOf);

class ConsistentRecordingTest : public RecordingTest {};

TEST_P(ConsistentRecordingTest, NoPoseBeyondTheTailOfItsCovariance) {
  EXPECT_GE(ChiSquareTail(score().poses6.worst_nees(), 6), 1e-9);
}

TEST_P(ConsistentRecordingTest, CentersSpreadAsStated) {
  EXPECT_TRUE(IsConsistent(score().centers, FamilyZ(kTests)));
}

TEST_P(ConsistentRecordingTest, PointsSpreadAsStated) {
  EXPECT_TRUE(IsConsistent(score().points, FamilyZ(kTests)));
}

TEST_P(ConsistentRecordingTest, PosesSpreadAsStated) {
  EXPECT_TRUE(IsConsistent(score().poses6, FamilyZ(kTests)));
}

INSTANTIATE_TEST_SUITE_P(Recordings, ConsistentRecordingTest,
                         ::testing::Values("demo", "easy", "spin_fixed", "wide_precession", "screw",
                                           "weak_light", "fast_blur"),
                         NameOf);

class AccurateRecordingTest : public RecordingTest {};

TEST_P(AccurateRecordingTest, CentersAreUnbiased) {
  for (const auto& camera : score().center_axes) {
    for (const ErrorStatistics& axis : camera) {
      EXPECT_LE(std::fabs(axis.bias()), 0.005);
      EXPECT_LE(std::fabs(axis.bias()), FamilyZ(kTests) * axis.stated_bias_sigma());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Recordings, AccurateRecordingTest, ::testing::Values("demo", "easy"),
                         NameOf);

/// Cramér–Rao bounds of a recording: a centre's per axis, a pose's as the root of its three axes'
/// summed variance, position at the balls' centroid.
struct Bounds {
  double center_px, position_mm, turn_rad;
};

void ExpectNearBounds(const RecordingScore& score, const Bounds& bounds) {
  for (const std::size_t axis : {0, 1}) {
    const double left_px = score.center_axes[0][axis].rmse();
    const double right_px = score.center_axes[1][axis].rmse();
    EXPECT_LE(std::hypot(left_px, right_px) / std::sqrt(2.0), 1.15 * bounds.center_px) << axis;
  }
  EXPECT_LE(score.centroid_mm.rmse(), 1.3 * bounds.position_mm);
  EXPECT_LE(score.turn_rad.rmse(), 1.3 * bounds.turn_rad);
}

TEST(EasyRecordingTest, ErrorsAreNearTheCramerRaoBound) {
  const Evaluation* easy = Evaluate("easy");
  if (easy == nullptr) GTEST_SKIP() << "the recording easy is not here";
  ExpectNearBounds(easy->score, {0.0033, 0.0081, 0.0022 * kDegree});  // data/README.md
}

TEST(DemoRecordingTest, ErrorsAreNearTheStatedOnes) {
  const RecordingScore& score = Evaluate("demo")->score;
  ExpectNearBounds(score, {score.centers.stated_rmse() / std::sqrt(2.0),
                           score.centroid_mm.stated_rmse(), score.turn_rad.stated_rmse()});
}

/// The rig's error is ONE draw for the whole recording, so the frames repeat one test of six
/// components: 4 σ, not a χ² over the frames.
TEST(ScrewRecordingTest, CalibrationUncertaintyExplainsTheErrors) {
  const Evaluation* screw = Evaluate("screw", "rig_calibrated.yaml");
  if (screw == nullptr) GTEST_SKIP() << "the recording screw is not here";
  ASSERT_EQ(screw->score.poses, screw->score.pairs);
  double worst_pose = 0;
  double worst_ball = 0;
  for (const PairMeasurement& measurement : screw->run.measurements) {
    const TrueFrame& truth = screw->run.truth.at(measurement.frame);
    const PoseEstimate& pose = *measurement.pose;
    ASSERT_TRUE(pose.calibration_u);
    const Vector6d error = PerturbationBetween(truth.world_from_body, pose.world_from_body);
    const Vector6d u2 = pose.calibration_u->cwiseAbs2() + pose.covariance.diagonal();
    worst_pose = std::max(worst_pose, error.cwiseAbs2().cwiseQuotient(u2).maxCoeff());
    for (const BallMeasurement& ball : measurement.balls) {
      if (!ball.p_in_world_mm) continue;
      const Eigen::Vector3d error_mm = *ball.p_in_world_mm - truth.Find(0, ball.id)->p_in_world_mm;
      const Eigen::Vector3d u2_mm2 =
          ball.calibration_u_mm.value().cwiseAbs2() + ball.covariance_mm2.diagonal();
      worst_ball = std::max(worst_ball, error_mm.cwiseAbs2().cwiseQuotient(u2_mm2).maxCoeff());
    }
  }
  EXPECT_LT(std::sqrt(worst_pose), 4);
  EXPECT_LT(std::sqrt(worst_ball), 4);
  RecordProperty("worst_pose_z", std::to_string(std::sqrt(worst_pose)));
  RecordProperty("worst_ball_z", std::to_string(std::sqrt(worst_ball)));
  fmt::print("screw with rig_calibrated.yaml: worst |error|/u, poses {:.2f}, balls {:.2f}\n",
             std::sqrt(worst_pose), std::sqrt(worst_ball));
}

/// Smears up to two diameters, curved by the body's turn: off by a T²/24, several σ of a pose.
TEST(FastBlurRecordingTest, PosesAreMovedToMidExposure) {
  const Evaluation* fast = Evaluate("fast_blur");
  if (fast == nullptr) GTEST_SKIP() << "the recording fast_blur is not here";
  EXPECT_EQ(fast->score.poses, fast->score.pairs);
  EXPECT_EQ(fast->run.summary.poses_moved_to_mid_exposure, fast->score.poses);
}

/// What these show (rods that cut limbs, merged balls, a time offset) is later work:
/// figures, no bars.
class HardRecordingTest : public RecordingTest {};

TEST_P(HardRecordingTest, RunsAndReports) {
  EXPECT_EQ(score().pairs, static_cast<int>(evaluation_->run.truth.size()));
  RecordProperty("figures", ScoreRow(GetParam(), score()));
}

INSTANTIATE_TEST_SUITE_P(Recordings, HardRecordingTest,
                         ::testing::Values("easy_rod", "overlap", "unsync"), NameOf);

}  // namespace
}  // namespace stereomotion::testing
