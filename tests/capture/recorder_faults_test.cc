// What goes wrong while it is recorded must not spoil what is there.

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <thread>

#include "recorded_frames.h"
#include "src/capture/folder_store.h"
#include "src/capture/hdf5/hdf5_store.h"
#include "src/capture/timestamps_csv.h"
#include "stereomotion/capture/recording.h"
#include "temporary_folder.h"

namespace stereomotion {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using testing::Message;
using testing::RecordPairs;
using testing::TemporaryFolder;

constexpr std::int64_t kRingBytes = 1 << 30;
// Several flushes.
constexpr milliseconds kUntilFlushed{800};

std::unique_ptr<Recorder> Start(const fs::path& output, const DiskCalls& disk) {
  const RecorderOptions options{output};
  return MakeRingRecorder(
      output.extension() == ".h5" ? MakeHdf5Store(options, disk) : MakeFolderStore(options, disk),
      kRingBytes);
}

std::unique_ptr<Recording> Open(const fs::path& file) {
  return OpenRecording(file.string() + ":cam0", file.string() + ":cam1");
}

/// A disk that is full in the middle of a row of timestamps.csv, once it is told to be.
class DiskFullInARow {
 public:
  explicit DiskFullInARow(bool for_ever) : for_ever_(for_ever) {}
  DiskCalls Calls() {
    DiskCalls disk;
    const auto write = disk.write;
    disk.write = [this, write](int fd, const iovec* pieces, int count, off_t offset) -> ssize_t {
      constexpr std::size_t kHeaderBytes = 13;  // of a PGM file; its image is written in rows
      const bool is_row = count == 1 && pieces[0].iov_len != kHeaderBytes;
      if (!is_row || !full || (tries_ >= 2 && !for_ever_)) return write(fd, pieces, count, offset);
      constexpr std::size_t kCutBytes = 25;
      const iovec part{pieces[0].iov_base, kCutBytes};
      if (++tries_ == 1) return write(fd, &part, 1, offset);
      errno = ENOSPC;
      return -1;
    };
    return disk;
  }
  std::atomic<bool> full{false};

 private:
  const bool for_ever_;
  std::atomic<int> tries_{0};
};

TEST(RecorderFaults, CutRowIsTakenBackAndWrittenAgain) {
  for (const bool for_ever : {false, true}) {
    TemporaryFolder folder;
    DiskFullInARow disk(for_ever);
    const fs::path output = folder.path() / "rec";
    const auto recorder = Start(output, disk.Calls());
    RecordPairs(*recorder, 0, 5);
    std::this_thread::sleep_for(kUntilFlushed);
    disk.full = true;
    RecordPairs(*recorder, 5, 9);
    std::this_thread::sleep_for(kUntilFlushed);
    recorder->Finish();
    EXPECT_NE(recorder->counts().problem.find("No space left"), std::string::npos);
    EXPECT_EQ(OpenRecording(output / "cam0", output / "cam1")->size(), for_ever ? 5 : 9);
    std::ifstream csv(output / "cam0" / "timestamps.csv");
    EXPECT_EQ(std::string((std::istreambuf_iterator<char>(csv)), {}).back(), '\n');
  }
}

TEST(RecorderFaults, CutLastRowIsLeftOut) {
  TemporaryFolder folder;
  const std::string whole = "frame,timestamp_ns,exposure_us,pair\n0,100,5,0\n1,110,5,1\n";
  for (const char* cut : {"2", "2,120", "2,120,", "2,120,5", "2,120,5,", "2,120,5,-", "2,12"}) {
    EXPECT_EQ(ReadTimestamps(folder.Write("timestamps.csv", whole + cut)).size(), 2U) << cut;
  }
  EXPECT_EQ(ReadTimestamps(folder.Write("timestamps.csv", whole + "2,120,5,2")).size(), 3U);
  const fs::path ended = folder.Write("timestamps.csv", whole + "2,120,\n");
  EXPECT_NE(Message([&] { ReadTimestamps(ended); }).find(":4: found no cell"), std::string::npos);
}

// After a refusal Linux calls the next synchronisation a success and may have lost the pages.
TEST(RecorderFaults, AfterAFailedSyncOnlyWhatWasNotedCounts) {
  TemporaryFolder folder;
  DiskCalls disk;
  const auto sync = disk.sync;
  std::atomic<int> failures{0};
  disk.sync = [&](int fd) {
    if (failures != 1) return sync(fd);
    ++failures;
    errno = EIO;
    return -1;
  };
  const auto file = folder.path() / "rec.h5";
  const auto recorder = Start(file, disk);
  RecordPairs(*recorder, 0, 10);
  std::this_thread::sleep_for(kUntilFlushed);
  RecordPairs(*recorder, 10, 20);
  failures = 1;
  std::this_thread::sleep_for(kUntilFlushed);
  recorder->Finish();
  EXPECT_EQ(failures, 2);
  EXPECT_NE(recorder->counts().problem.find("cannot be brought to the disk"), std::string::npos);
  EXPECT_EQ(Open(file)->size(), 10);
  fs::remove(file);  // made anew it holds no more
  EXPECT_EQ(RepairRecording(file).frames[0], 10);
}

TEST(RecorderFaults, UnreadableSegmentIsAProblem) {
  TemporaryFolder folder;
  const auto file = folder.path() / "rec.h5";
  auto recorder = StartRecorder({file});
  RecordPairs(*recorder, 0, 100);
  std::this_thread::sleep_for(kUntilFlushed);
  const auto segment = folder.path() / "rec.h5.segments" / "000000.h5";
  const auto whole = folder.path() / "whole.h5";
  fs::copy_file(segment, whole);
  fs::resize_file(segment, 1000);
  recorder->Finish();
  EXPECT_NE(recorder->counts().problem.find("000000.h5: cannot be read as an HDF5 file"),
            std::string::npos)
      << recorder->counts().problem;
  EXPECT_TRUE(NeedsRepair(file));
  recorder.reset();
  fs::rename(whole, segment);
  EXPECT_EQ(RepairRecording(file).frames[0], 100);
}

// A file that grows no more, as on a full disk: HDF5 cannot close it, and tried again at the
// program's exit.
TEST(RecorderFaultsDeathTest, ProgramEndsByItselfWhenNoSegmentCanBeCreated) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  TemporaryFolder folder;
  const auto record = [&] {
    std::signal(SIGXFSZ, SIG_IGN);  // the write fails instead
    constexpr rlim_t kMost_bytes = 20000;
    const rlimit limit{kMost_bytes, kMost_bytes};
    setrlimit(RLIMIT_FSIZE, &limit);
    const auto recorder = StartRecorder({folder.path() / "rec.h5"});
    RecordPairs(*recorder, 0, 200);
    recorder->Finish();
    std::exit(recorder->counts().problem.empty() ? 1 : 0);
  };
  EXPECT_EXIT(record(), ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace stereomotion
