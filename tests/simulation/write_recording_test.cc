#include "stereomotion/simulation/write_recording.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <stdexcept>
#include <string>

#include "tests/simulation/test_scenario.h"

namespace stereomotion {
namespace {

namespace fs = std::filesystem;
using testing::MakeTestScenario;

std::string BytesOf(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

std::map<std::string, std::string> FilesUnder(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    files[fs::relative(entry.path(), folder).string()] = BytesOf(entry.path());
  }
  return files;
}

class WriteRecordingTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(::testing::TempDir()) / (std::string("recording_") + info->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path folder_;
};

TEST_F(WriteRecordingTest, SameBytesFromAnyNumberOfThreads) {
  WriteRecordingOptions options;
  options.threads = 1;
  EXPECT_EQ(WriteRecording(MakeTestScenario(), folder_ / "one", options), 3);
  options.threads = 3;
  std::int64_t told = 0;
  options.on_progress = [&](std::int64_t done, std::int64_t) { told = done; };
  EXPECT_EQ(WriteRecording(MakeTestScenario(), folder_ / "three", options), 3);
  EXPECT_EQ(told, 3);
  const auto files = FilesUnder(folder_ / "one");
  EXPECT_EQ(files.size(), 2U * 4 + 3);
  EXPECT_TRUE(files == FilesUnder(folder_ / "three"));
}

TEST_F(WriteRecordingTest, TruthHasARowAFrameAndABallAnImage) {
  WriteRecording(MakeTestScenario(), folder_);
  const std::string poses = BytesOf(folder_ / "truth/poses.csv");
  const std::string balls = BytesOf(folder_ / "truth/balls.csv");
  EXPECT_EQ(std::count(poses.begin(), poses.end(), '\n'), 1 + 3);
  EXPECT_EQ(std::count(balls.begin(), balls.end(), '\n'), 1 + 3 * 2 * 10);
  EXPECT_EQ(BytesOf(folder_ / "cam1/timestamps.csv"),
            "frame,timestamp_ns,exposure_us\n0,1000000000,8000\n1,1033333333,8000\n"
            "2,1066666667,8000\n");
}

TEST_F(WriteRecordingTest, StopsWhenAsked) {
  const std::atomic<bool> stop{true};
  WriteRecordingOptions options;
  options.stop = &stop;
  EXPECT_EQ(WriteRecording(MakeTestScenario(), folder_, options), 0);
}

TEST_F(WriteRecordingTest, SaysWhichFileFails) {
  std::ofstream(folder_ / "cam0") << "in the way";
  try {
    WriteRecording(MakeTestScenario(), folder_);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("cam0"), std::string::npos);
  }
}

TEST_F(WriteRecordingTest, RejectsNamesThatLeaveTheFolder) {
  Scenario scenario = MakeTestScenario();
  for (const char* name : {"", "..", "a/b", "/tmp", "truth", "cam1"}) {
    scenario.rig.cameras[0].name = name;
    EXPECT_THROW(WriteRecording(scenario, folder_), std::invalid_argument) << name;
  }
}

}  // namespace
}  // namespace stereomotion
