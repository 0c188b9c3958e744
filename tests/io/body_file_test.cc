#include "stereomotion/io/body_file.h"

#include <gtest/gtest.h>

#include "io_test_support.h"

namespace stereomotion {
namespace {

using testing::Error;
using testing::Has;
using testing::TextFile;

std::string BodyText(const std::string& diameter, const std::string& balls,
                     const std::string& more = "") {
  return "format: stereomotion-body/1\nname: plate\nrods:\n  - name: A\n    ball_diameter_mm: " +
         diameter + "\n    balls_mm: " + balls + "\n" + more;
}

constexpr const char* kBalls = "[[0,0,0],[40,0,0],[95,0,0],[165,0,0],[250,0,0]]";

std::string ErrorOf(const std::string& text) {
  const TextFile file("body.yaml", text);
  return Error([&] { ReadBody(file.path()); });
}

TEST(BodyFile, ReadsAllKeys) {
  const TextFile file("body.yaml", BodyText("16", kBalls, "    sigma_mm: 0.05\n"));
  const Body body = ReadBody(file.path());
  EXPECT_EQ(body.name, "plate");
  ASSERT_EQ(body.rods.size(), 1U);
  EXPECT_EQ(body.rods[0].name, "A");
  EXPECT_EQ(body.rods[0].ball_diameter_mm, 16);
  EXPECT_EQ(body.rods[0].sigma_mm, 0.05);
  EXPECT_EQ(body.rods[0].balls_in_body_mm.at(3), Eigen::Vector3d(165, 0, 0));
}

TEST(BodyFile, ExampleIsValid) {
  EXPECT_EQ(ReadBody(testing::SourceFile("calib/body.yaml")).rods.size(), 2U);
}

TEST(BodyFile, UnknownKeyIsNamedWithItsLineAndASuggestion) {
  const std::string error = ErrorOf(BodyText("16", kBalls, "    sigma: 0.05\n"));
  EXPECT_TRUE(Has(error, "body.yaml:7: rods[0].sigma: unknown key 'sigma'")) << error;
  EXPECT_TRUE(Has(error, "did you mean 'sigma_mm'?")) << error;
}

TEST(BodyFile, MissingKey) {
  const std::string error = ErrorOf("format: stereomotion-body/1\nrods:\n  - name: A\n");
  EXPECT_TRUE(Has(error, "body.yaml:3: rods[0]: the key 'ball_diameter_mm' is missing")) << error;
}

TEST(BodyFile, WrongFormat) {
  EXPECT_TRUE(Has(ErrorOf("format: stereomotion-rig/1\n"), "expected 'stereomotion-body/1'"));
  EXPECT_TRUE(Has(ErrorOf("rods: []\n"), "the key 'format' is missing"));
  EXPECT_TRUE(Has(ErrorOf(""), "found nothing, expected a map with the key 'format'"));
}

TEST(BodyFile, FolderOrUnreadableFile) {
  const auto error = [](const char* file) { return Error([&] { ReadBody(file); }); };
  EXPECT_TRUE(Has(error("/tmp"), "/tmp: found a folder, expected a YAML file"));
  EXPECT_TRUE(Has(error("/nowhere/body.yaml"), "cannot be read, expected a YAML file"));
  // Opens, but its first byte cannot be read, not even by root.
  EXPECT_TRUE(Has(error("/proc/self/mem"), "cannot be read to its end")) << error("/proc/self/mem");
}

TEST(BodyFile, NotYaml) { EXPECT_TRUE(Has(ErrorOf("a: [1, 2\nb: }"), "is not valid YAML")); }

TEST(BodyFile, MissingFile) {
  EXPECT_TRUE(Has(Error([] { ReadBody("/nowhere/body.yaml"); }), "cannot be read"));
}

TEST(BodyFile, WrongTypes) {
  EXPECT_TRUE(Has(ErrorOf(BodyText("big", kBalls)), "found 'big', expected a number"));
  EXPECT_TRUE(Has(ErrorOf(BodyText(".nan", kBalls)), "expected a finite number"));
  EXPECT_TRUE(Has(ErrorOf(BodyText("-16", kBalls)), "found -16, expected a number above 0"));
  EXPECT_TRUE(Has(ErrorOf(BodyText("16", "7")), "found '7', expected a list"));
  EXPECT_TRUE(Has(ErrorOf(BodyText("16", "[[0,0],[1,0,0],[2,0,0]]")),
                  "balls_mm[0]: found a list of 2, expected a list of 3 numbers"));
}

TEST(BodyFile, TheSameKeyTwice) {
  EXPECT_TRUE(Has(ErrorOf(BodyText("16", kBalls, "    ball_diameter_mm: 17\n")), "twice"));
}

TEST(BodyFile, MetresForMillimetres) {
  const std::string all = ErrorOf(BodyText("0.016", "[[0,0,0],[0.04,0,0],[0.095,0,0]]"));
  EXPECT_TRUE(Has(all, "found 0.016, expected 0.5 to 500 mm (0.016 m would be 16 mm")) << all;
  const std::string balls = ErrorOf(BodyText("16", "[[0,0,0],[0.04,0,0],[0.095,0,0]]"));
  EXPECT_TRUE(Has(balls, "a body of 0.095 mm")) << balls;
  EXPECT_TRUE(Has(balls, "not metres")) << balls;
}

TEST(BodyFile, BallsCloserThanTheirDiameter) {
  const std::string error = ErrorOf(BodyText("16", "[[0,0,0],[15,0,0],[95,0,0]]"));
  EXPECT_TRUE(Has(error, "balls 0 and 1 only 15 mm apart, expected at least their diameter, 16 mm"))
      << error;
}

TEST(BodyFile, CrookedRodTellsHowFarOff) {
  const std::string error = ErrorOf(BodyText("16", "[[0,0,0],[100,9,0],[200,0,0]]"));
  EXPECT_TRUE(Has(error, "ball 1 lies 6 mm off the line of rod A")) << error;  // 9 · 2/3
  EXPECT_EQ(ErrorOf(BodyText("16", "[[0,0,0],[100,1,0],[200,0,0]]")), "no error");
}

TEST(BodyFile, BallsOutOfOrder) {
  const std::string error = ErrorOf(BodyText("16", "[[0,0,0],[200,0,0],[100,0,0],[300,0,0]]"));
  EXPECT_TRUE(Has(error, "in the order in which they are threaded")) << error;
}

TEST(BodyFile, TooFewOrTooManyBalls) {
  EXPECT_TRUE(Has(ErrorOf(BodyText("16", "[[0,0,0],[200,0,0]]")), "found 2 balls"));
  EXPECT_TRUE(Has(ErrorOf("format: stereomotion-body/1\nrods: []\n"), "no rods"));
}

TEST(BodyFile, TwoRodsOfOneName) {
  const std::string rod =
      std::string("  - name: A\n    ball_diameter_mm: 16\n    balls_mm: ") + kBalls;
  EXPECT_TRUE(Has(ErrorOf(BodyText("16", kBalls, rod + "\n")), "'A' twice"));
}

TEST(BodyFile, NamesThatWouldBreakACsv) {
  EXPECT_TRUE(
      Has(ErrorOf("format: stereomotion-body/1\nname: 'a,b'\nrods: []\n"), "without commas"));
}

}  // namespace
}  // namespace stereomotion
