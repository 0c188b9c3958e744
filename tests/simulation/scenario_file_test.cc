#include "stereomotion/io/scenario_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "stereomotion/core/user_error.h"

namespace stereomotion {
namespace {

namespace fs = std::filesystem;

const fs::path kSource = STEREOMOTION_SOURCE_DIR;

/// Makes a scenario file that uses the demo's rig and body.
class ReadScenarioTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(::testing::TempDir()) / (std::string("scenario_") + info->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  [[nodiscard]] ScenarioFile Read(const std::string& motion, const std::string& rest) const {
    std::ofstream(folder_ / "scenario.yaml")
        << "format: stereomotion-scenario/1\nrig: " << (kSource / "data/demo/rig.yaml").string()
        << "\nbody: " << (kSource / "data/demo/body.yaml").string() << "\nmotion: {" << motion
        << "}\n"
        << rest;
    return ReadScenario(folder_ / "scenario.yaml");
  }

  /// Expects a `UserError` whose message has the file, the line and `words`.
  void ExpectError(const std::string& motion, const std::string& rest,
                   const std::string& words) const {
    try {
      const ScenarioFile read = Read(motion, rest);
      ADD_FAILURE() << read.scenario.name << ": no error with " << words;
    } catch (const UserError& error) {
      EXPECT_NE(std::string(error.what()).find("scenario.yaml:"), std::string::npos);
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  }

  fs::path folder_;
};

constexpr char kFixed[] = "law: fixed, axis: [0, 0, 2], rate_rad_s: 0.5";
constexpr char kRun[] = "frames: 3\nfps: 25\n";

TEST_F(ReadScenarioTest, ReadsEveryKey) {
  const Scenario scenario =
      Read(
          "law: precession, center_in_body_mm: [1, 2, 3], center_in_world_mm: [4, 5, 6], "
          "world_from_body: {qw: 0, qx: 1, qy: 0, qz: 0}, axis: [0, 2, 0], rate_rad_s: 3, "
          "precession_axis: [0, 0, -1], precession_rate_rad_s: 2, velocity_mm_s: [7, 8, 9]",
          "light: {ball_level: 0.5, background_level: 0.1, limb_falloff: 0.2, "
          "ball_slope: [0.1, -0.2], background_slope: [0.3, 0.4], blur_px: 0.7}\n"
          "sensor: {bits: 12, full_well_e: 9000, read_e: 4, exposure_s: 0.002}\n"
          "false_balls: [{xyz_mm: [1, 1, 2], diameter_mm: 5}]\n"
          "frames: 4\nfps: 50\nlag_s: -0.003\nlag_reported: true\nseed: 9\nname: all\n")
          .scenario;
  EXPECT_EQ(scenario.motion.center_in_body_mm, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(scenario.motion.center_in_world_mm, Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(scenario.motion.world_from_body.x(), 1);
  EXPECT_EQ(scenario.motion.spin_in_world_rad_s, Eigen::Vector3d(0, 3, 0));
  EXPECT_EQ(scenario.motion.precession_in_world_rad_s, Eigen::Vector3d(0, 0, -2));
  EXPECT_EQ(scenario.motion.velocity_in_world_mm_s, Eigen::Vector3d(7, 8, 9));
  EXPECT_EQ(scenario.light.ball_level, 0.5);
  EXPECT_EQ(scenario.light.background_level, 0.1);
  EXPECT_EQ(scenario.light.limb_falloff, 0.2);
  EXPECT_EQ(scenario.light.ball_slope, Eigen::Vector2d(0.1, -0.2));
  EXPECT_EQ(scenario.light.background_slope, Eigen::Vector2d(0.3, 0.4));
  EXPECT_EQ(scenario.light.blur_px, 0.7);
  EXPECT_EQ(scenario.sensor.bits, 12);
  EXPECT_EQ(scenario.sensor.full_well_e, 9000);
  EXPECT_EQ(scenario.sensor.read_e, 4);
  EXPECT_EQ(scenario.sensor.exposure_s, 0.002);
  ASSERT_EQ(scenario.false_balls.size(), 1U);
  EXPECT_EQ(scenario.false_balls[0].diameter_mm, 5);
  EXPECT_EQ(scenario.frames, 4);
  EXPECT_EQ(scenario.fps, 50);
  EXPECT_EQ(scenario.lag_s, -0.003);
  EXPECT_TRUE(scenario.lag_reported);
  EXPECT_EQ(scenario.seed, 9U);
  EXPECT_EQ(scenario.name, "all");
}

TEST_F(ReadScenarioTest, ScrewMovesAlongItsAxis) {
  const Scenario scenario =
      Read("law: screw, axis: [0, 0, 2], rate_rad_s: 0.5, pitch_mm_per_rad: 8", kRun).scenario;
  EXPECT_EQ(scenario.motion.velocity_in_world_mm_s, Eigen::Vector3d(0, 0, 4));
}

TEST_F(ReadScenarioTest, LeftOutKeysKeepTheirDefaults) {
  const Scenario scenario = Read(kFixed, kRun).scenario;
  EXPECT_EQ(scenario.name, "scenario");
  EXPECT_EQ(scenario.light.ball_level, SceneLight{}.ball_level);
  EXPECT_EQ(scenario.sensor.bits, 8);
  EXPECT_EQ(scenario.rig.cameras.size(), 2U);
  EXPECT_EQ(scenario.body.rods.size(), 2U);
}

TEST_F(ReadScenarioTest, CommentedExampleIsValid) {
  const fs::path example = kSource / "calib/scenario.yaml";
  EXPECT_EQ(ReadScenario(example).scenario.frames, 20);
}

TEST_F(ReadScenarioTest, NamesWhatIsWrong) {
  const std::string run = kRun;
  ExpectError(kFixed, run + "lihgt: {}\n", "light");
  ExpectError(kFixed, "fps: 25\n", "'frames' is missing");
  ExpectError(kFixed, "frames: 0\nfps: 25\n", "frames");
  ExpectError(kFixed, "frames: 1\nfps: -25\n", "fps");
  ExpectError(kFixed, run + "lag_reported: perhaps\n", "true or false");
  ExpectError(kFixed, run + "sensor: {bits: 7}\n", "bits");
  ExpectError(kFixed, run + "light: {blur_px: .nan}\n", "finite");
  ExpectError(kFixed, run + "light: {ball_slope: [1]}\n", "2 numbers");
  ExpectError(kFixed, run + "false_balls: [{xyz_mm: [0, 0, 0]}]\n", "diameter_mm");
  ExpectError("law: wild, axis: [0, 0, 1], rate_rad_s: 1", run, "precession");
  ExpectError("law: fixed, axis: [0, 0, 0], rate_rad_s: 1", run, "direction");
  ExpectError("law: fixed, axis: [0, 0, 1]", run, "rate_rad_s");
  ExpectError(std::string(kFixed) + ", pitch_mm_per_rad: 3", run, "pitch_mm_per_rad");
  ExpectError(std::string(kFixed) + ", world_from_body: {qw: 1, qx: 1, qy: 0, qz: 0}", run,
              "length 1");
  ExpectError(kFixed, run + "light: {ball_level: 0}\n", "light levels");
}

}  // namespace
}  // namespace stereomotion
