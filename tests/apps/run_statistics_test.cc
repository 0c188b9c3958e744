#include "apps/run_statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/support/test_rng.h"

namespace stereomotion::app {
namespace {

// Log-normal about 0.02 px, the spread of residuals that recordings show.
double DrawRmsPx(std::mt19937_64& rng) {
  return 0.02 * std::exp(0.3 * stereomotion::testing::NormalVector<1>(rng)[0]);
}

double MedianRmsPx(std::int64_t poses) {
  std::mt19937_64 rng(7);
  RunStatistics statistics;
  for (std::int64_t i = 0; i < poses; ++i) {
    PairMeasurement measurement;
    measurement.pose.emplace();
    measurement.pose->rms_px = DrawRmsPx(rng);
    statistics.Add(measurement);
  }
  BodySummary summary;
  summary.poses = poses;
  const std::string rows = statistics.Rows(summary, poses);
  const std::string label = "residual rms, median";
  return std::stod(rows.substr(rows.find(label) + label.size()));
}

TEST(RunStatistics, MediansOfFewAndOfManyPoses) {
  constexpr double kRounding = 5e-5;  // the table has four digits
  constexpr double kTwoPercent = 0.02;
  EXPECT_NEAR(MedianRmsPx(1001), 0.02, kTwoPercent * 0.02 + kRounding);
  // More than are kept: every second, fourth, eighth stands for all.
  for (const std::int64_t poses : {16384, 40000, 150000}) {
    EXPECT_NEAR(MedianRmsPx(poses), 0.02, kTwoPercent * 0.02 + kRounding) << poses;
  }
}

TEST(RunStatistics, NoPoseNoMedian) {
  EXPECT_EQ(RunStatistics().Rows({}, 5).find("median"), std::string::npos);
}

}  // namespace
}  // namespace stereomotion::app
