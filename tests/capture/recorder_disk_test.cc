// Disks that are full, slow or broken: what is lost is counted, what is there is whole.

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <fstream>
#include <thread>

#include "recorded_frames.h"
#include "src/capture/folder_store.h"
#include "src/capture/hdf5/hdf5_store.h"
#include "stereomotion/capture/recording.h"
#include "temporary_folder.h"

namespace stereomotion {
namespace {

using std::chrono::milliseconds;
using testing::MakeFrame;
using testing::SameImage;
using testing::TemporaryFolder;

constexpr std::int64_t kRingBytes = 20 * 2 * 37 * 23;  // twenty pairs

std::unique_ptr<Recorder> Start(const std::filesystem::path& output, const DiskCalls& disk,
                                std::int64_t ring_bytes = kRingBytes) {
  const RecorderOptions options{output};
  return MakeRingRecorder(
      output.extension() == ".h5" ? MakeHdf5Store(options, disk) : MakeFolderStore(options, disk),
      ring_bytes);
}

/// Checks that all that can be read is whole and rightly paired; returns the pairs.
std::int64_t CountRightPairs(const std::filesystem::path& output) {
  const bool is_file = output.extension() == ".h5";
  const auto recording = is_file
                             ? OpenRecording(output.string() + ":cam0", output.string() + ":cam1")
                             : OpenRecording(output / "cam0", output / "cam1");
  FramePair pair;
  std::int64_t pairs = 0;
  for (std::int64_t i = 0; i < recording->size(); ++i) {
    recording->Read(i, pair);
    const std::int64_t number = pair.left.index;
    EXPECT_EQ(pair.right.index, MakeFrame(1, number)->index);
    EXPECT_TRUE(SameImage(pair.left.image.View(), MakeFrame(0, number)->image.View()));
    EXPECT_TRUE(SameImage(pair.right.image.View(), MakeFrame(1, number)->image.View()));
    pairs += pair.right.index >= 0 ? 1 : 0;
  }
  return pairs;
}

class DiskTest : public ::testing::TestWithParam<const char*> {
 protected:
  [[nodiscard]] std::filesystem::path Output() const { return folder_.path() / GetParam(); }
  TemporaryFolder folder_;
};

TEST_P(DiskTest, SlowOneDropsWholePairs) {
  DiskCalls disk;
  const auto write = disk.write;
  disk.write = [&](int fd, const iovec* pieces, int count, off_t offset) {
    std::this_thread::sleep_for(milliseconds(1));
    return write(fd, pieces, count, offset);
  };
  const auto recorder = Start(Output(), disk);
  constexpr int kPairs = 150;
  for (int i = 0; i < kPairs; ++i) {
    recorder->Take(MakeFrame(0, i), MakeFrame(1, i));
    std::this_thread::sleep_for(milliseconds(1));
  }
  recorder->Finish();
  const RecorderCounts counts = recorder->counts();
  EXPECT_EQ(counts.problem, "");
  EXPECT_GT(counts.dropped, 0);
  EXPECT_EQ(counts.pairs + counts.dropped, kPairs);
  EXPECT_EQ(counts.frames[0], counts.pairs);
  EXPECT_EQ(counts.frames[1], counts.pairs);
  EXPECT_EQ(CountRightPairs(Output()), counts.pairs);
}

TEST_P(DiskTest, WritesInPiecesAndInterrupted) {
  DiskCalls disk;
  const auto write = disk.write;
  std::atomic<int> calls{0};
  disk.write = [&](int fd, const iovec* pieces, int, off_t offset) -> ssize_t {
    if (++calls % 3 == 0) {
      errno = EINTR;
      return -1;
    }
    const iovec part{pieces[0].iov_base, std::max<std::size_t>(pieces[0].iov_len / 2, 1)};
    return write(fd, &part, 1, offset);
  };
  const auto recorder = Start(Output(), disk, 1 << 30);
  testing::RecordPairs(*recorder, 0, 40);
  recorder->Finish();
  EXPECT_EQ(recorder->counts().problem, "");
  EXPECT_EQ(CountRightPairs(Output()), 40);
}

TEST_P(DiskTest, BrokenOneEndsTheRecording) {
  DiskCalls disk;
  const auto write = disk.write;
  std::atomic<int> calls{0};
  disk.write = [&](int fd, const iovec* pieces, int count, off_t offset) -> ssize_t {
    constexpr int kGood = 300;
    if (++calls <= kGood) return write(fd, pieces, count, offset);
    errno = EIO;
    return -1;
  };
  const auto recorder = Start(Output(), disk, 1 << 30);
  testing::RecordPairs(*recorder, 0, 200);
  recorder->Finish();
  const RecorderCounts counts = recorder->counts();
  EXPECT_NE(counts.problem.find("cannot be written: Input/output error"), std::string::npos)
      << counts.problem;
  EXPECT_EQ(counts.pairs + counts.dropped, 200);
  EXPECT_GT(counts.dropped, 0);
}

INSTANTIATE_TEST_SUITE_P(Both, DiskTest, ::testing::Values("rec.h5", "rec"));

TEST(RecorderDisk, FullWhenASegmentIsMade) {
  TemporaryFolder folder;
  DiskCalls disk;
  const auto allocate = disk.allocate;
  std::atomic<int> calls{0};
  disk.allocate = [&](int fd, off_t bytes) {
    if (++calls <= 2) return allocate(fd, bytes);
    errno = ENOSPC;
    return -1;
  };
  const auto recorder = Start(folder.path() / "rec.h5", disk, 1 << 30);
  testing::RecordPairs(*recorder, 0, 500);
  recorder->Finish();
  const RecorderCounts counts = recorder->counts();
  EXPECT_NE(counts.problem.find("there is no room for it: No space left"), std::string::npos)
      << counts.problem;
  EXPECT_EQ(counts.pairs + counts.dropped, 500);
  EXPECT_GT(counts.pairs, 0);
  EXPECT_EQ(CountRightPairs(folder.path() / "rec.h5"), counts.pairs);
}

TEST(RecorderDisk, SynchronisingFails) {
  TemporaryFolder folder;
  DiskCalls disk;
  std::atomic<bool> broken{false};
  const auto sync = disk.sync;
  disk.sync = [&](int fd) {
    if (!broken) return sync(fd);
    errno = EIO;
    return -1;
  };
  const auto recorder = Start(folder.path() / "rec.h5", disk, 1 << 30);
  testing::RecordPairs(*recorder, 0, 20);
  std::this_thread::sleep_for(milliseconds(200));
  broken = true;
  recorder->Finish();
  EXPECT_NE(recorder->counts().problem.find("cannot be brought to the disk"), std::string::npos);
}

constexpr int kNotPermitted = 77;

// Mounts a disk of 4 MB that this process alone sees.
bool MountSmallDisk(const std::filesystem::path& folder) {
  const std::string user = "0 " + std::to_string(getuid()) + " 1";
  const std::string group = "0 " + std::to_string(getgid()) + " 1";
  if (unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) return false;
  std::ofstream("/proc/self/setgroups") << "deny";
  std::ofstream("/proc/self/uid_map") << user;
  std::ofstream("/proc/self/gid_map") << group;
  return mount("none", folder.c_str(), "tmpfs", 0, "size=4m") == 0;
}

int RecordOnto(const std::filesystem::path& folder) try {
  if (!MountSmallDisk(folder)) return kNotPermitted;
  const auto file = folder / "rec.h5";
  const auto recorder = Start(file, {}, 1 << 30);
  constexpr int kPairs = 10000;  // 17 MB
  for (int i = 0; i < kPairs; ++i) recorder->Take(MakeFrame(0, i), MakeFrame(1, i));
  recorder->Finish();
  const RecorderCounts counts = recorder->counts();
  EXPECT_NE(counts.problem.find("No space left"), std::string::npos) << counts.problem;
  EXPECT_EQ(counts.pairs + counts.dropped, kPairs);
  // Most of the disk is used, and all of it can be read.
  EXPECT_GT(counts.bytes, 2 << 20);
  EXPECT_EQ(CountRightPairs(file), counts.pairs);
  EXPECT_FALSE(NeedsRepair(file));
  return ::testing::Test::HasFailure() ? 1 : 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}

TEST(RecorderDisk, RealFullDisk) {
  TemporaryFolder folder;
  const pid_t child = fork();
  if (child == 0) _exit(RecordOnto(folder.path()));
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  if (WEXITSTATUS(status) == kNotPermitted)
    GTEST_SKIP() << "no user namespaces here: no small disk";
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
}  // namespace stereomotion
