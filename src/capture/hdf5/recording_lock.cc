#include "recording_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "stereomotion/core/output_error.h"
#include "stereomotion/core/user_error.h"

namespace stereomotion {
namespace {

namespace fs = std::filesystem;

fs::path MarkOf(const fs::path& recording) { return SegmentFolder(recording) / "unfinished"; }

// Joining writes 40 bytes a frame; this is enough for an hour at 100 Hz. On a disk that is full by
// then it would not fit.
constexpr off_t kReserveBytes = 32 << 20;
// Such a small part of a disk is reserved at most.
constexpr std::uintmax_t kSmallPart = 16;

// Names the time since the disk was mounted, as far as the kernel does; 0: it does not.
std::uint64_t MountOf(int fd) {
  constexpr unsigned kNeverUsedAgain = 0x4000;  // STATX_MNT_ID_UNIQUE of Linux 6.8
  struct statx about {};
  for (const unsigned kind : {kNeverUsedAgain, unsigned{STATX_MNT_ID}}) {
    if (statx(fd, "", AT_EMPTY_PATH, kind, &about) == 0 && (about.stx_mask & kind) != 0) {
      return about.stx_mnt_id;
    }
  }
  return 0;
}

// Names the time in which the kernel brings all that is written to the disk: since the computer was
// started and the disk mounted.
std::string SessionOf(int fd) {
  std::string boot;
  std::getline(std::ifstream("/proc/sys/kernel/random/boot_id"), boot);
  return boot + " " + std::to_string(MountOf(fd));
}

std::string ReadLine(const fs::path& file) {
  std::string line;
  std::ifstream stream(file);
  std::getline(stream, line);
  return line;
}

}  // namespace

fs::path LinkedFile(const fs::path& file) {
  std::error_code error;
  if (!fs::is_symlink(file, error)) return file;
  const fs::path linked = fs::weakly_canonical(file, error);
  return error ? file : linked;
}

fs::path SegmentFolder(const fs::path& recording) {
  return LinkedFile(recording).string() + ".segments";
}

RecordingLock::RecordingLock(const fs::path& recording, Use use) : file_(MarkOf(recording)) {
  const int create = use == Use::kRecord ? O_CREAT : 0;
  fd_ = open(file_.c_str(), O_RDWR | O_CLOEXEC | create, 0666);
  if (fd_ < 0) {
    throw OutputError(file_.string() + ": cannot be opened for writing: " + std::strerror(errno));
  }
  if (flock(fd_, LOCK_EX | LOCK_NB) != 0) {
    const bool is_held = errno == EWOULDBLOCK;
    const std::string why = std::strerror(errno);
    close(fd_);
    if (!is_held) throw OutputError(file_.string() + ": cannot be locked: " + why);
    throw UserError(recording.string() +
                    ": is still being recorded by another program; wait until that has ended");
  }
  if (use == Use::kRecord) {
    Write(SessionOf(fd_));
  } else {
    may_be_torn_ = ReadLine(file_) != SessionOf(fd_);
  }
}

RecordingLock::~RecordingLock() { close(fd_); }

void RecordingLock::Write(const std::string& session) {
  const std::string text = session +
                           "\nThis recording is not finished: `stereomotion record --repair`" +
                           " makes it readable after a crash.\n";
  const bool done = ftruncate(fd_, 0) == 0 &&
                    pwrite(fd_, text.data(), text.size(), 0) == static_cast<ssize_t>(text.size()) &&
                    fsync(fd_) == 0;
  if (done) {
    std::error_code none;
    const std::uintmax_t part = fs::space(file_, none).available / kSmallPart;
    const off_t bytes = std::min<std::uintmax_t>(part, kReserveBytes);
    // Refused: then there is none, and joining may have to wait for `record --repair`.
    if (!none && bytes > 0) static_cast<void>(fallocate(fd_, 0, 0, bytes));
    return;
  }
  const std::string why = std::strerror(errno);
  close(fd_);
  throw OutputError(file_.string() + ": cannot be written: " + why);
}

void RecordingLock::Distrust() {
  // Refused by that disk, too: then it counts as before.
  if (pwrite(fd_, "!", 1, 0) != 1) return;
}

void RecordingLock::FreeReserve() const {
  // The first line stays, for the time until all is joined. Refused: it is only less room.
  const auto line = static_cast<off_t>(ReadLine(file_).size() + 1);
  if (ftruncate(fd_, line) != 0) return;
}

void RecordingLock::Remove() {
  if (unlink(file_.c_str()) != 0 && errno != ENOENT) {
    throw OutputError(file_.string() + ": cannot be removed: " + std::strerror(errno));
  }
}

bool IsMarkedUnfinished(const fs::path& recording) {
  std::error_code none;
  return fs::is_regular_file(MarkOf(recording), none);
}

}  // namespace stereomotion
