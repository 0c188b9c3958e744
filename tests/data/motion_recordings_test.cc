#include <gtest/gtest.h>

#include "tests/support/motion_evaluation.h"
#include "tests/support/recording_run.h"
#include "tests/support/statistics.h"

namespace stereomotion::testing {
namespace {

/// Two-sided tests of this program: of each recording the centre (law given and chosen), the axis
/// in world and body, and three frames' ω and v.
constexpr int kRecordings = 12;
constexpr int kTests = kRecordings * (2 + 2 + 2 * 3);

class MotionRecordingTest : public ::testing::TestWithParam<MovingRecording> {
 protected:
  void SetUp() override {
    evaluation_ = Evaluate(GetParam());
    if (evaluation_ == nullptr) {
      GTEST_SKIP() << (SharedData() / "rendered" / GetParam().name).string()
                   << " is not here (set STEREOMOTION_SHARED_DATA)";
    }
  }
  [[nodiscard]] const MotionScore& score() const { return evaluation_->score; }
  const MotionEvaluation* evaluation_ = nullptr;
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
    ::testing::Values(MovingRecording{"demo", PathLaw::kUniform, false},
                      MovingRecording{"easy", PathLaw::kUniform},
                      MovingRecording{"easy_rod", PathLaw::kUniform},
                      MovingRecording{"spin_fixed", PathLaw::kFixed},
                      MovingRecording{"screw", PathLaw::kUniform},
                      MovingRecording{"screw", PathLaw::kUniform, true, "rig_calibrated.yaml"},
                      MovingRecording{"wide_precession", PathLaw::kFixed, false},
                      MovingRecording{"weak_light", PathLaw::kUniform},
                      MovingRecording{"clutter", PathLaw::kUniform},
                      MovingRecording{"occlusion", PathLaw::kFixed},
                      MovingRecording{"fast_blur", PathLaw::kUniform},
                      MovingRecording{"unsync", PathLaw::kUniform}),
    [](const auto& one) { return KeyOf(one.param); });

/// Its balls cross each other, and its centre wanders by no law.
TEST(MotionOfOverlap, NoWrongCenter) {
  const MotionEvaluation* evaluation = Evaluate({"overlap", PathLaw::kAccelerated, false});
  if (evaluation == nullptr) GTEST_SKIP() << "no overlap";
  EXPECT_TRUE(evaluation->chosen.spin.law == PathLaw::kFree || evaluation->chosen.spin.center);
}

}  // namespace
}  // namespace stereomotion::testing
