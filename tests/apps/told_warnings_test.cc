#include "told_warnings.h"

#include <gtest/gtest.h>

namespace stereomotion::app {
namespace {

LiveReport Report(std::vector<std::string> warnings) {
  LiveReport report;
  report.cameras[0].uri = "aravis:127.0.0.1";
  report.cameras[1].uri = "aravis:127.0.0.2";
  report.warnings = std::move(warnings);
  return report;
}

TEST(ToldWarnings, NumbersThatChangeAreNotNews) {
  ToldWarnings told;
  EXPECT_EQ(told.New(Report({"the images are up to 2.50 ms apart (-0.1 s)"})).size(), 1U);
  EXPECT_TRUE(told.New(Report({"the images are up to 12.75 ms apart (0.2 s)"})).empty());
}

TEST(ToldWarnings, WhatFollowsTheKindIsNotNews) {
  ToldWarnings told;
  const std::string kind = "the cameras free-run against each other: ";
  EXPECT_EQ(told.New(Report({kind + "aravis:127.0.0.2's images lie 3 ms before"})).size(), 1U);
  EXPECT_TRUE(told.New(Report({kind + "aravis:127.0.0.2's images lie 5 ms after"})).empty());
  EXPECT_TRUE(told.New(Report({kind + "the images of a pair are up to 9 ms apart"})).empty());
}

TEST(ToldWarnings, CamerasThatDifferInNumbersOnlyAreTwo) {
  ToldWarnings told;
  const auto text = [](int camera, int times) {
    return "aravis:127.0.0." + std::to_string(camera) + ": set " + std::to_string(times) +
           " times, see docs";
  };
  EXPECT_EQ(told.New(Report({text(1, 3), text(2, 3)})).size(), 2U);
  EXPECT_TRUE(told.New(Report({text(2, 4), text(1, 5)})).empty());
}

// A list that is built anew may lose its first warning, which moves the others.
TEST(ToldWarnings, TheirPlaceInTheListDoesNotMatter) {
  ToldWarnings told;
  EXPECT_EQ(told.New(Report({"free-run"})).size(), 1U);
  const auto fresh = told.New(Report({"receive buffer", "free-run"}));
  ASSERT_EQ(fresh.size(), 1U);
  EXPECT_EQ(fresh.front(), "receive buffer");
}

TEST(ToldWarnings, OfTheRecorder) {
  ToldWarnings told;
  LiveReport report = Report({});
  RecorderCounts counts;
  AddRecorderWarnings(counts, report);
  EXPECT_TRUE(report.warnings.empty());
  counts.dropped = 1;
  AddRecorderWarnings(counts, report);
  ASSERT_EQ(told.New(report).size(), 1U);
  EXPECT_NE(report.warnings.back().find("too slow"), std::string::npos);
  counts.dropped = 20;
  AddRecorderWarnings(counts, report);
  EXPECT_TRUE(told.New(report).empty());
  counts.problem = "rec.h5: disk full";
  LiveReport full = Report({});
  AddRecorderWarnings(counts, full);
  ASSERT_EQ(told.New(full).size(), 1U);
  EXPECT_EQ(full.warnings.back().find("too slow"), std::string::npos);
}

}  // namespace
}  // namespace stereomotion::app
