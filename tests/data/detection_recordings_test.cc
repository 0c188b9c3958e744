#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "tests/support/detection_score.h"
#include "tests/support/recording_run.h"

namespace stereomotion::testing {
namespace {

struct Bar {
  const char* recording;
  double bound_px;       ///< Cramér–Rao, ../shared/data/README.md; 0: none given
  double least_visible;  ///< balls hidden further are not asked for
  double least_recall;
  double largest_ratio;  ///< of RMSE to the bound; DESIGN.md: at so few images 1.3
  double largest_bias_px;
};

/// Issue 4, bars 1 and 3; the biases: 0.003 px where the balls are isolated and bright, 0.005 px
/// with rods; beside them the 4 σ that chance allows.
const Bar kBars[] = {
    {"easy", 0.0033, 0.9, 0.995, 1.3, 0.003},
    {"easy_rod", 0.0030, 0.9, 0.98, 1.3, 0.005},
    {"spin_fixed", 0.0023, 0.9, 0.995, 1.3, 0.003},
    {"screw", 0.0034, 0.9, 0.995, 1.3, 0.003},
    {"weak_light", 0.033, 0.9, 0.995, 1.3, 0.01},
    {"clutter", 0, 0.9, 0.995, 0, 0.005},
    {"occlusion", 0, 0.5, 0.98, 0, 0},
    {"overlap", 0, 0.5, 0.98, 0, 0},
    {"wide_precession", 0.0031, 0.9, 0.995, 1.3, 0.003},
};
/// Two-sided tests in this program: a NEES a recording.
constexpr int kTests = static_cast<int>(std::size(kBars));

std::map<std::string, DetectionScore>& Scores() {
  static std::map<std::string, DetectionScore> scores;
  return scores;
}

/// Prints the figures of every recording at the end.
class DetectionTable : public ::testing::Environment {
 public:
  void TearDown() override {
    if (!Scores().empty()) fmt::print("\n{}", DetectionHeader());
    for (const auto& [name, score] : Scores()) fmt::print("{}", DetectionRow(name, score));
  }
};
const ::testing::Environment* const kTable =
    ::testing::AddGlobalTestEnvironment(new DetectionTable);

class DetectionRecordingTest : public ::testing::TestWithParam<Bar> {
 protected:
  void SetUp() override {
    const auto folder = SharedData() / "rendered" / GetParam().recording;
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not here";
    const auto known = Scores().find(GetParam().recording);
    score_ = known != Scores().end() ? known->second
                                     : ScoreDetections(folder, {}, GetParam().least_visible);
    Scores()[GetParam().recording] = score_;
  }
  DetectionScore score_;
};

TEST_P(DetectionRecordingTest, FindsTheBalls) {
  EXPECT_GE(score_.recall(), GetParam().least_recall);
}

TEST_P(DetectionRecordingTest, ReachesTheBound) {
  if (GetParam().bound_px > 0) {
    EXPECT_LE(score_.axis_rmse_px(), GetParam().largest_ratio * GetParam().bound_px);
  }
  for (const ErrorStatistics& axis : score_.axes) {
    if (GetParam().largest_bias_px <= 0) continue;
    EXPECT_LE(std::fabs(axis.bias()), GetParam().largest_bias_px + 4 * axis.stated_bias_sigma());
  }
}

TEST_P(DetectionRecordingTest, StatesItsErrorsTruly) {
  EXPECT_TRUE(IsConsistent(score_.centers, FamilyZ(kTests)));
  EXPECT_EQ(score_.wrong, 0);
}

INSTANTIATE_TEST_SUITE_P(All, DetectionRecordingTest, ::testing::ValuesIn(kBars),
                         [](const ::testing::TestParamInfo<Bar>& test) {
                           return std::string(test.param.recording);
                         });

/// Where no round thing but the balls is in the picture, nothing else is taken for one.
TEST(DetectionRecording, NoFalseDetectionInWeakLight) {
  const auto folder = SharedData() / "rendered/weak_light";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not here";
  EXPECT_LE(ScoreDetections(folder).false_per_image(), 0.1);
}

}  // namespace
}  // namespace stereomotion::testing
