#include "stereomotion/capture/recorder.h"

#include <gtest/gtest.h>

#include <fstream>

#include "recorded_frames.h"
#include "stereomotion/capture/recording.h"
#include "stereomotion/core/user_error.h"
#include "temporary_folder.h"

namespace stereomotion {
namespace {

using testing::MakeFrame;
using testing::Message;
using testing::RecordPairs;
using testing::SameImage;
using testing::TemporaryFolder;

std::unique_ptr<Recording> Open(const std::filesystem::path& file) {
  return OpenRecording(file.string() + ":cam0", file.string() + ":cam1", {0, true});
}

class RecorderRoundTrip : public ::testing::TestWithParam<PixelType> {};

// Odd widths have rows with padding in memory; 200 pairs take several segments.
TEST_P(RecorderRoundTrip, GivesBackWhatWasTaken) {
  TemporaryFolder folder;
  const auto file = folder.path() / "rec.h5";
  const auto recorder = StartRecorder({file});
  EXPECT_TRUE(NeedsRepair(file));
  RecordPairs(*recorder, 0, 200, GetParam());
  recorder->Finish();
  EXPECT_EQ(recorder->counts().problem, "");
  EXPECT_EQ(recorder->counts().pairs, 200);
  EXPECT_EQ(recorder->counts().dropped, 0);
  EXPECT_FALSE(NeedsRepair(file));
  const auto recording = Open(file);
  ASSERT_EQ(recording->size(), 200);
  FramePair pair;
  for (int i = 0; i < 200; ++i) {
    ASSERT_TRUE(recording->Read(i, pair));
    for (const auto& [frame, camera] : {std::pair{&pair.left, 0}, {&pair.right, 1}}) {
      const auto taken = MakeFrame(camera, i, GetParam());
      ASSERT_EQ(frame->problem, "");
      EXPECT_EQ(frame->index, taken->index);
      EXPECT_EQ(frame->timestamp_ns, taken->timestamp_ns);
      EXPECT_EQ(frame->exposure_us, taken->exposure_us);
      ASSERT_TRUE(SameImage(frame->image.View(), taken->image.View())) << camera << " " << i;
      EXPECT_EQ(frame->image.View().grey_bits, taken->image.View().grey_bits);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Pixels, RecorderRoundTrip,
                         ::testing::Values(PixelType::kGray8, PixelType::kGray16));

TEST(Recorder, PairsAreThoseOfTheTake) {
  TemporaryFolder folder;
  const auto file = folder.path() / "rec.h5";
  const auto recorder = StartRecorder({file});
  recorder->Take(nullptr, MakeFrame(1, 0));  // the right camera comes first
  recorder->Take(MakeFrame(0, 0), nullptr);  // the same moment: by time they would be a pair
  recorder->Take(MakeFrame(0, 1), MakeFrame(1, 1));
  recorder->Take(MakeFrame(0, 2), MakeFrame(1, 3));
  recorder->Finish();
  EXPECT_EQ(CamerasOfRecording(file), (std::vector<std::string>{"cam0", "cam1"}));
  const auto recording = Open(file);
  ASSERT_EQ(recording->size(), 3);
  EXPECT_EQ(recording->report().unpaired_left, 1);
  EXPECT_EQ(recording->report().unpaired_right, 1);
  FramePair pair;
  recording->Read(0, pair);
  EXPECT_EQ(pair.right.index, -1);
  recording->Read(1, pair);
  EXPECT_EQ(pair.right.index, MakeFrame(1, 1)->index);
  recording->Read(2, pair);
  EXPECT_EQ(pair.right.index, MakeFrame(1, 3)->index);
}

TEST(Recorder, SidesMayBeSwapped) {
  TemporaryFolder folder;
  const auto file = folder.path() / "rec.h5";
  const auto recorder = StartRecorder({file});
  RecordPairs(*recorder, 0, 5);
  recorder->Finish();
  const auto recording = OpenRecording(file.string() + ":cam1", file.string() + ":cam0");
  FramePair pair;
  recording->Read(4, pair);
  EXPECT_TRUE(SameImage(pair.left.image.View(), MakeFrame(1, 4)->image.View()));
  EXPECT_NE(Message([&] { OpenRecording(file.string() + ":cam1", file.string() + ":cam1"); }), "");
  EXPECT_EQ(Message([&] { OpenRecording(file.string() + ":cam7", file.string() + ":cam0"); }),
            file.string() + ": holds no camera 'cam7', expected one of: cam0, cam1");
}

TEST(Recorder, MovedRecordingIsReadable) {
  TemporaryFolder folder;
  const auto recorder = StartRecorder({folder.path() / "a" / "50%b.h5"});
  RecordPairs(*recorder, 0, 3);
  recorder->Finish();
  std::filesystem::rename(folder.path() / "a", folder.path() / "b");
  const auto recording = Open(folder.path() / "b" / "50%b.h5");
  FramePair pair;
  recording->Read(2, pair);
  EXPECT_TRUE(SameImage(pair.right.image.View(), MakeFrame(1, 2)->image.View()));
}

TEST(Recorder, ExistingRecordingIsKept) {
  TemporaryFolder folder;
  const auto file = folder.path() / "rec.h5";
  const auto first = StartRecorder({file});
  RecordPairs(*first, 0, 1);
  first->Finish();
  EXPECT_EQ(Message([&] { StartRecorder({file}); }),
            file.string() + ": exists; give another --output, or --force to replace the recording");
  RecorderOptions options{file};
  options.overwrite = true;
  const auto recorder = StartRecorder(options);
  RecordPairs(*recorder, 0, 2);
  // While it is recorded nobody takes it away, repairs or reads it.
  const std::string busy =
      file.string() + ": is still being recorded by another program; wait until that has ended";
  EXPECT_EQ(Message([&] { StartRecorder(options); }), busy);
  EXPECT_EQ(Message([&] { RepairRecording(file); }), busy);
  EXPECT_EQ(Message([&] { Open(file); }), busy);
  recorder->Finish();
  EXPECT_EQ(Open(file)->size(), 2);
}

TEST(Recorder, ForeignFilesAreNeverRemoved) {
  TemporaryFolder folder;
  const auto file = folder.path() / "rec.h5";
  folder.Write("rec.h5.segments/thesis.txt", "text");
  RecorderOptions options{file};
  options.overwrite = true;
  EXPECT_NE(Message([&] { StartRecorder(options); }).find("thesis.txt, which belongs to no"),
            std::string::npos);
  options.output = folder.path() / "images";
  folder.Write("images/cam0/thesis.txt", "text");
  EXPECT_NE(Message([&] { StartRecorder(options); }).find("thesis.txt, which was not recorded"),
            std::string::npos);
}

TEST(Recorder, ImagesOfAnotherSizeEndIt) {
  TemporaryFolder folder;
  const auto file = folder.path() / "rec.h5";
  const auto recorder = StartRecorder({file});
  RecordPairs(*recorder, 0, 4);
  auto other = std::make_shared<Frame>(*MakeFrame(0, 4));
  other->image.Resize(10, 10, PixelType::kGray8);
  recorder->Take(other, MakeFrame(1, 4));
  recorder->Finish();
  EXPECT_NE(recorder->counts().problem.find("now sends images of 10 x 10 px"), std::string::npos);
  EXPECT_EQ(recorder->counts().dropped, 1);
  EXPECT_EQ(Open(file)->size(), 4);
}

TEST(RecordingArgument, IsSplit) {
  std::filesystem::path file;
  std::string camera;
  EXPECT_TRUE(SplitRecordingArgument("a/rec.h5:cam0", file, camera));
  EXPECT_EQ(file, "a/rec.h5");
  EXPECT_EQ(camera, "cam0");
  EXPECT_TRUE(SplitRecordingArgument("rec.hdf5", file, camera));
  EXPECT_EQ(camera, "");
  EXPECT_TRUE(SplitRecordingArgument("REC.H5:cam0", file, camera));
  EXPECT_EQ(file, "REC.H5");
  EXPECT_FALSE(SplitRecordingArgument("aravis:rec", file, camera));
  EXPECT_FALSE(SplitRecordingArgument("rec/cam0", file, camera));
}

}  // namespace
}  // namespace stereomotion
