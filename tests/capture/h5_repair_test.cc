// Recording files: what a repair makes of one that is cut and of no segments; a disk that is soon
// full.

#include <gtest/gtest.h>

#include <atomic>
#include <cerrno>

#include "recorded_frames.h"
#include "src/capture/hdf5/hdf5_store.h"
#include "src/capture/ring_recorder.h"
#include "stereomotion/capture/recorder.h"
#include "temporary_folder.h"

namespace stereomotion {
namespace {

using testing::TemporaryFolder;

// A disk that was full, a copy that broke off: the seal is gone with the end.
TEST(H5Repair, CutMasterIsMadeAnew) {
  TemporaryFolder folder;
  const auto file = folder.path() / "rec.h5";
  const auto recorder = StartRecorder({file});
  testing::RecordPairs(*recorder, 0, 20);
  recorder->Finish();
  const auto bytes = std::filesystem::file_size(file);
  for (const std::uintmax_t left : {std::uintmax_t{0}, std::uintmax_t{1000}, bytes - 1}) {
    std::filesystem::resize_file(file, left);
    EXPECT_EQ(RepairRecording(file).frames[0], 20) << left;
    EXPECT_EQ(std::filesystem::file_size(file), bytes) << left;
  }
}

TEST(H5Repair, NothingIsMadeOfNoSegments) {
  TemporaryFolder folder;
  const auto file = folder.path() / "rec.h5";
  std::filesystem::create_directories(folder.path() / "rec.h5.segments");
  for (const bool has_nonsense : {false, true}) {
    if (has_nonsense) folder.Write("rec.h5.segments/000000.h5", "This is no HDF5 file.");
    const RepairReport report = RepairRecording(file);
    EXPECT_EQ(report.frames[0], 0);
    EXPECT_NE(report.notes.back().find("nothing was written"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(file));
  }
}

// Room for forty images; the left camera begins one image earlier.
TEST(H5SmallDisk, SomePairsFitWhereOneCameraBeginsFirst) {
  constexpr int kSide_px = 256;
  TemporaryFolder folder;
  DiskCalls disk;
  std::atomic<std::int64_t> free_bytes{40 * kSide_px * kSide_px};
  disk.allocate = [&](int, off_t bytes) {
    if (bytes <= free_bytes) {
      free_bytes -= bytes;
      return 0;
    }
    errno = ENOSPC;
    return -1;
  };
  const auto recorder =
      MakeRingRecorder(MakeHdf5Store({folder.path() / "rec.h5"}, disk), std::int64_t{1} << 30);
  const auto frame = [](int camera, std::int64_t number) {
    return testing::MakeFrame(camera, number, PixelType::kGray8, kSide_px, kSide_px);
  };
  recorder->Take(frame(0, 0), nullptr);
  for (int i = 1; i < 30; ++i) recorder->Take(frame(0, i), frame(1, i));
  recorder->Finish();
  EXPECT_NE(recorder->counts().problem, "");
  EXPECT_GE(recorder->counts().pairs, 8);
}

}  // namespace
}  // namespace stereomotion
