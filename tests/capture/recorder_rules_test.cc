// What a recorder takes, and what it leaves alone.

#include <gtest/gtest.h>

#include <fstream>

#include "recorded_frames.h"
#include "stereomotion/capture/recording.h"
#include "temporary_folder.h"

namespace stereomotion {
namespace {

namespace fs = std::filesystem;
using testing::MakeFrame;
using testing::Message;
using testing::RecordPairs;
using testing::SameImage;
using testing::TemporaryFolder;

TEST(RecorderRules, TwoIntoOneFolder) {
  TemporaryFolder folder;
  RecorderOptions options{folder.path() / "rec"};
  options.overwrite = true;
  const auto recorder = StartRecorder(options);
  RecordPairs(*recorder, 0, 5);
  EXPECT_EQ(Message([&] { StartRecorder(options); }),
            options.output.string() +
                ": is still being recorded by another program; wait until that has ended");
  recorder->Finish();
  EXPECT_EQ(OpenRecording(options.output / "cam0", options.output / "cam1")->size(), 5);
}

TEST(RecorderRules, NamesWithSigns) {
  TemporaryFolder folder;
  RecorderOptions options{folder.path() / "rec.h5"};
  options.names = {"50%b", "%%"};
  const auto recorder = StartRecorder(options);
  RecordPairs(*recorder, 0, 5);
  recorder->Finish();
  EXPECT_EQ(recorder->counts().problem, "");
  FramePair pair;
  const std::string file = options.output.string();
  OpenRecording(file + ":50%b", file + ":%%")->Read(4, pair);
  EXPECT_TRUE(SameImage(pair.right.image.View(), MakeFrame(1, 4)->image.View()));
  options.output = folder.path() / "other.h5";
  for (const char* name : {"a:b", "a/b"}) {
    options.names[0] = name;
    EXPECT_NE(Message([&] { StartRecorder(options); }).find("a name without '/' and ':'"),
              std::string::npos);
  }
}

TEST(RecorderRules, OthersFilesAmongSegmentsStay) {
  TemporaryFolder folder;
  const auto file = folder.path() / "rec.h5";
  const auto recorder = StartRecorder({file});
  RecordPairs(*recorder, 0, 5);
  recorder->Finish();
  const auto segments = folder.path() / "rec.h5.segments";
  for (const char* name : {"results.h5", "draft.part", "123456.h5"}) {
    std::ofstream(segments / name) << "mine";
  }
  fs::remove(file);
  RepairRecording(file);
  for (const char* name : {"results.h5", "draft.part", "123456.h5"}) {
    EXPECT_TRUE(fs::exists(segments / name)) << name;
  }
  RecorderOptions options{file};
  options.overwrite = true;
  EXPECT_NE(Message([&] { StartRecorder(options); }).find("which belongs to no recording"),
            std::string::npos);
}

TEST(RecorderRules, NothingIsLeftOfNothing) {
  TemporaryFolder folder;
  const auto file = folder.path() / "rec.h5";
  StartRecorder({file})->Finish();
  EXPECT_FALSE(fs::exists(file));
  EXPECT_FALSE(fs::exists(file.string() + ".segments"));
}

TEST(RecorderRules, OtherImagesEndIt) {
  for (const char* name : {"rec.h5", "rec"}) {
    TemporaryFolder folder;
    const auto recorder = StartRecorder({folder.path() / name});
    RecordPairs(*recorder, 0, 3);
    RecordPairs(*recorder, 3, 4, PixelType::kGray16);
    recorder->Finish();
    EXPECT_NE(recorder->counts().problem.find(
                  "now sends images of 37 x 23 px, 16 bit, before 37 x 23 px, 8 bit"),
              std::string::npos)
        << recorder->counts().problem;
    EXPECT_EQ(recorder->counts().pairs, 3);
  }
}

}  // namespace
}  // namespace stereomotion
