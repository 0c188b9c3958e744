#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "stereomotion/motion/analyse_motion.h"
#include "stereomotion/pipeline/motion_data_of.h"
#include "tests/support/motion_bound.h"
#include "tests/support/motion_score.h"
#include "tests/support/recording_run.h"
#include "tests/support/statistics.h"
#include "tests/support/true_scene.h"

namespace stereomotion::testing {
namespace {

namespace fs = std::filesystem;

/// Describes a recording: how its body truly moves, and whether about one axis.
struct Recording {
  const char* name;
  PathLaw law;
  bool one_axis = true;
  const char* rig = "rig.yaml";
};

/// Two-sided tests of this program: of each recording the centre (law given and chosen), the axis
/// in world and body, and three frames' ω and v.
constexpr int kRecordings = 12;
constexpr int kTests = kRecordings * (2 + 2 + 2 * 3);

struct Evaluation {
  RecordingRun run;
  MotionData data;
  MotionAnalysis chosen;  ///< all options at their defaults
  MotionAnalysis given;   ///< the true law given
  MotionScore score;
};

std::map<std::string, Evaluation>& Evaluations() {
  static std::map<std::string, Evaluation> evaluations;
  return evaluations;
}

std::string KeyOf(const Recording& recording) {
  return std::string(recording.name) +
         (std::string(recording.rig) == "rig.yaml" ? "" : "_other_rig");
}

/// Measures and analyses a recording once a program; null where it is not on this machine.
const Evaluation* Evaluate(const Recording& recording) {
  const auto known = Evaluations().find(KeyOf(recording));
  if (known != Evaluations().end()) return &known->second;
  const fs::path folder = std::string(recording.name) == "demo"
                              ? DemoRecording()
                              : SharedData() / "rendered" / recording.name;
  if (!fs::exists(folder)) return nullptr;
  Evaluation evaluation;
  evaluation.run = MeasureFolder(folder, recording.rig);
  evaluation.data = MotionDataOf(evaluation.run.setup, evaluation.run.measurements);
  evaluation.chosen = AnalyseMotion(evaluation.data);
  AnalyseOptions options;
  options.center.law = recording.law;
  evaluation.given = AnalyseMotion(evaluation.data, options);
  evaluation.score = ScoreMotion(evaluation.given, evaluation.chosen, evaluation.data,
                                 evaluation.run.truth, recording.one_axis);
  return &Evaluations().emplace(KeyOf(recording), std::move(evaluation)).first->second;
}

/// Prints the figures of every recording that the program has measured.
class FiguresTable : public ::testing::Environment {
 public:
  void TearDown() override {
    if (Evaluations().empty()) return;
    fmt::print("\n{}", MotionScoreHeader());
    for (const auto& [name, evaluation] : Evaluations()) {
      fmt::print("{}", MotionScoreRow(name, evaluation.score));
    }
    for (const auto& [name, evaluation] : Evaluations()) {
      fmt::print("{:16} {}\n", name, evaluation.chosen.spin.verdict);
    }
  }
};
const ::testing::Environment* const kFiguresTable =
    ::testing::AddGlobalTestEnvironment(new FiguresTable);

class MotionRecordingTest : public ::testing::TestWithParam<Recording> {
 protected:
  void SetUp() override {
    evaluation_ = Evaluate(GetParam());
    if (evaluation_ == nullptr) {
      GTEST_SKIP() << (SharedData() / "rendered" / GetParam().name).string()
                   << " is not here (set STEREOMOTION_SHARED_DATA)";
    }
  }
  [[nodiscard]] const MotionScore& score() const { return evaluation_->score; }
  const Evaluation* evaluation_ = nullptr;
};

TEST_P(MotionRecordingTest, OneAxisIsFoundWhereThereIsOne) {
  ASSERT_TRUE(evaluation_->given.spin.center);
  EXPECT_EQ(evaluation_->given.spin.center->free_axis_in_body.has_value(), GetParam().one_axis);
}

TEST_P(MotionRecordingTest, CenterUnderTheTrueLaw) {
  EXPECT_TRUE(IsConsistent(score().center_given, FamilyZ(kTests)));
}

TEST_P(MotionRecordingTest, CenterUnderTheChosenLaw) {
  if (!evaluation_->chosen.spin.center) GTEST_SKIP() << "law free: no centre, which is honest";
  EXPECT_TRUE(IsConsistent(score().center_chosen, FamilyZ(kTests)));
}

TEST_P(MotionRecordingTest, NoNarrowerLawThanTheTrueOne) {
  EXPECT_GE(evaluation_->chosen.spin.law, GetParam().law);
}

TEST_P(MotionRecordingTest, Axis) {
  if (!GetParam().one_axis) GTEST_SKIP() << "more than one axis";
  EXPECT_TRUE(IsConsistent(score().axis_in_world, FamilyZ(kTests)));
  EXPECT_TRUE(IsConsistent(score().axis_in_body, FamilyZ(kTests)));
}

TEST_P(MotionRecordingTest, AngularVelocity) {
  for (const ErrorStatistics& frame : score().omega) {
    EXPECT_TRUE(IsConsistent(frame, FamilyZ(kTests)));
  }
}

TEST_P(MotionRecordingTest, VelocityOfTheCenter) {
  for (const ErrorStatistics& frame : score().velocity) {
    if (GetParam().law == PathLaw::kFixed) {
      EXPECT_EQ(frame.samples(), 0);  // at rest: an exact zero
    } else {
      EXPECT_TRUE(IsConsistent(frame, FamilyZ(kTests)));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Recordings, MotionRecordingTest,
    ::testing::Values(
        Recording{"demo", PathLaw::kUniform, false}, Recording{"easy", PathLaw::kUniform},
        Recording{"easy_rod", PathLaw::kUniform}, Recording{"spin_fixed", PathLaw::kFixed},
        Recording{"screw", PathLaw::kUniform},
        Recording{"screw", PathLaw::kUniform, true, "rig_calibrated.yaml"},
        Recording{"wide_precession", PathLaw::kFixed, false},
        Recording{"weak_light", PathLaw::kUniform}, Recording{"clutter", PathLaw::kUniform},
        Recording{"occlusion", PathLaw::kFixed}, Recording{"fast_blur", PathLaw::kUniform},
        Recording{"unsync", PathLaw::kUniform}),
    [](const auto& one) { return KeyOf(one.param); });

/// σ across the axis by assumed law, as ../shared/data/README.md states it [mm], and the position
/// and rotation bounds of one frame that stand there too.
struct TellableCenter {
  const char* name;
  PathLaw law;  ///< by which it truly moves
  double by_law_mm[3];
  double position_mm, rotation_deg;
};

class TellableCenterTest : public ::testing::TestWithParam<TellableCenter> {
 protected:
  void SetUp() override {
    evaluation_ = Evaluate({GetParam().name, GetParam().law});
    if (evaluation_ == nullptr) GTEST_SKIP() << "no " << GetParam().name;
    scene_ = TrueScene(evaluation_->data, evaluation_->run.truth, true);
  }
  const Evaluation* evaluation_ = nullptr;
  MotionScene scene_;
};

double Largest(const Eigen::Matrix3d& covariance_mm2) {
  return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance_mm2).eigenvalues()[2]);
}

/// The README's figures hold for noise that is as large in every direction as the position's whole
/// σ. That ties the bound of these tests to figures made by another hand.
TEST_P(TellableCenterTest, BoundForEvenNoiseIsTheReadmes) {
  const double per_component = std::sqrt(3.0);
  const MotionScene even = WithEvenNoise(scene_, per_component * GetParam().position_mm,
                                         per_component * GetParam().rotation_deg * M_PI / 180);
  for (const PathLaw law : {PathLaw::kFixed, PathLaw::kUniform, PathLaw::kAccelerated}) {
    const double stated_mm = GetParam().by_law_mm[static_cast<int>(law)];
    // Figures of one digit: 0.06 is anything from 0.055 to 0.065.
    EXPECT_NEAR(Largest(BoundOf(even, law).center_mm2) / stated_mm, 1, 0.09);
  }
}

/// What the images truly know is more: they see poorly along their depth only, and that is almost
/// the axis here. The bound is linear in the centre's error as long as that times the rotation's σ
/// is small against the position's: 1 µm / 2.5e-5 rad = 50 mm. Farther out the body's lever, and
/// with it what a pose says, changes with the centre; then the stated σ is the estimate's own
/// (its coverage: spin_center_monte_carlo_test), and must say that nothing is known.
TEST_P(TellableCenterTest, SigmaByLawIsTheBound) {
  constexpr double kLinear_mm = 50;
  for (const PathLaw law : {PathLaw::kFixed, PathLaw::kUniform, PathLaw::kAccelerated}) {
    const double bound_mm = Largest(BoundOf(scene_, law).center_mm2);
    const double sigma_mm = SigmaAcross(evaluation_->chosen.spin, law);
    fmt::print("{:12} {:12} sigma across the axis {:8.4g} mm, bound {:8.4g} mm\n", GetParam().name,
               LawWord(law), sigma_mm, bound_mm);
    if (law < GetParam().law) continue;  // refuted: it has no centre, or one far away
    if (bound_mm < kLinear_mm) {
      EXPECT_NEAR(sigma_mm / bound_mm, 1, bound_mm < kLinear_mm / 10 ? 0.05 : 0.25);
    } else {
      EXPECT_GT(sigma_mm, kLinear_mm);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Recordings, TellableCenterTest,
    ::testing::Values(
        TellableCenter{"easy", PathLaw::kUniform, {0.06, 4.4, 465}, 0.0081, 0.0022},
        TellableCenter{"spin_fixed", PathLaw::kFixed, {0.012, 0.4, 21}, 0.0032, 0.0015},
        TellableCenter{"weak_light", PathLaw::kUniform, {1.15, 122, 20e3}, 0.076, 0.021}),
    [](const auto& one) { return one.param.name; });

/// Its balls cross each other, and its centre wanders by no law.
TEST(MotionOfOverlap, NoWrongCenter) {
  const Evaluation* evaluation = Evaluate({"overlap", PathLaw::kAccelerated, false});
  if (evaluation == nullptr) GTEST_SKIP() << "no overlap";
  EXPECT_TRUE(evaluation->chosen.spin.law == PathLaw::kFree || evaluation->chosen.spin.center);
}

}  // namespace
}  // namespace stereomotion::testing
