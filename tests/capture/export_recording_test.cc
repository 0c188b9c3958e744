#include "stereomotion/capture/export_recording.h"

#include <gtest/gtest.h>

#include "recorded_frames.h"
#include "stereomotion/capture/recording.h"
#include "temporary_folder.h"

namespace stereomotion {
namespace {

using testing::MakeFrame;
using testing::Message;
using testing::RecordPairs;
using testing::SameImage;
using testing::TemporaryFolder;

TEST(FolderRecorder, RoundTrip) {
  for (const PixelType type : {PixelType::kGray8, PixelType::kGray16}) {
    TemporaryFolder folder;
    const auto output = folder.path() / "rec";
    const auto recorder = StartRecorder({output});
    RecordPairs(*recorder, 0, 12, type);
    recorder->Finish();
    EXPECT_EQ(recorder->counts().problem, "");
    const auto recording = OpenRecording(output / "cam0", output / "cam1");
    ASSERT_EQ(recording->size(), 12);
    FramePair pair;
    recording->Read(11, pair);
    EXPECT_EQ(pair.left.exposure_us, MakeFrame(0, 11)->exposure_us);
    EXPECT_EQ(pair.left.timestamp_ns, MakeFrame(0, 11)->timestamp_ns);
    EXPECT_TRUE(SameImage(pair.right.image.View(), MakeFrame(1, 11, type)->image.View()));
  }
}

// Free-running cameras: frames that were no pair in the take lie nearer than half a period.
TEST(FolderRecorder, TellsThePairsOfTheTake) {
  TemporaryFolder folder;
  const auto output = folder.path() / "rec";
  const auto recorder = StartRecorder({output});
  recorder->Take(MakeFrame(0, 0), nullptr);
  recorder->Take(nullptr, MakeFrame(1, 0));
  recorder->Take(MakeFrame(0, 1), MakeFrame(1, 1));
  recorder->Finish();
  const auto recording = OpenRecording(output / "cam0", output / "cam1");
  EXPECT_EQ(recording->report().pairs, 1);
  FramePair pair;
  recording->Read(0, pair);
  EXPECT_EQ(pair.right.index, -1);
}

TEST(ExportRecording, ReadsBackTheSame) {
  for (const PixelType type : {PixelType::kGray8, PixelType::kGray16}) {
    for (const char* extension : {".png", ".tif", ".pgm"}) {
      TemporaryFolder folder;
      const auto file = folder.path() / "rec.h5";
      const auto recorder = StartRecorder({file, {"links", "rechts"}});
      recorder->Take(MakeFrame(0, 0, type), nullptr);
      RecordPairs(*recorder, 1, 6, type);
      recorder->Finish();
      const ExportOptions options{folder.path() / "out", extension};
      EXPECT_EQ(ExportRecording(file, options), 11);
      const auto before = OpenRecording(file.string() + ":links", file.string() + ":rechts");
      const auto after = OpenRecording(options.output / "links", options.output / "rechts");
      ASSERT_EQ(after->size(), before->size());
      EXPECT_EQ(after->report().pairs, 5);
      FramePair a, b;
      for (std::int64_t i = 0; i < before->size(); ++i) {
        before->Read(i, a);
        after->Read(i, b);
        EXPECT_EQ(a.left.index, b.left.index);
        EXPECT_EQ(a.left.timestamp_ns, b.left.timestamp_ns);
        EXPECT_EQ(a.left.exposure_us, b.left.exposure_us);
        EXPECT_EQ(a.right.index, b.right.index);
        EXPECT_TRUE(SameImage(a.left.image.View(), b.left.image.View())) << extension;
        if (b.right.index < 0) continue;
        EXPECT_TRUE(SameImage(a.right.image.View(), b.right.image.View())) << extension;
      }
      EXPECT_NE(Message([&] { ExportRecording(file, options); }).find("exists; give another"),
                std::string::npos);
    }
  }
}

}  // namespace
}  // namespace stereomotion
