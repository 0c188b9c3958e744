#include "record_disk.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <vector>

#include "stereomotion/core/output_error.h"

namespace stereomotion::app {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

// Enough to see a disk that is too slow, not so much that one waits for it.
constexpr std::chrono::milliseconds kMeasureFor{400};
constexpr std::size_t kPieceBytes = 4 << 20;
constexpr double kMostBytes = 256 << 20;
constexpr double kSmallPart = 0.05;  // of the free room

double SecondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// The folder into which the output comes, or would come once the missing ones are made: nothing is
// left behind where there is nothing to record.
fs::path FolderOf(const fs::path& output) {
  fs::path folder = fs::absolute(output).lexically_normal().parent_path();
  std::error_code none;
  while (!fs::exists(folder, none) && folder.has_relative_path()) folder = folder.parent_path();
  return folder;
}

// What the kernel merely keeps in memory tells nothing of the disk: each piece is synchronised.
double MeasureSpeed(const fs::path& folder, double most_bytes) {
  const fs::path file = folder / (".stereomotion-speed-" + std::to_string(getpid()));
  const int fd = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (fd < 0) throw OutputError(folder.string() + ": cannot be written: " + std::strerror(errno));
  unlink(file.c_str());
  const std::vector<char> piece(kPieceBytes, 'x');
  double bytes = 0;
  const Clock::time_point start = Clock::now();
  while (bytes < most_bytes && Clock::now() - start < kMeasureFor) {
    const ssize_t n = write(fd, piece.data(), piece.size());
    if (n <= 0 || fdatasync(fd) != 0) break;
    bytes += static_cast<double>(n);
  }
  const double elapsed_s = SecondsSince(start);
  close(fd);
  return elapsed_s > 0 ? bytes / elapsed_s : 0;
}

}  // namespace

double FreeBytes(const fs::path& output) {
  std::error_code error;
  const fs::space_info space = fs::space(FolderOf(output), error);
  return error ? 0 : static_cast<double>(space.available);
}

DiskState LookAtDisk(const fs::path& output) {
  const fs::path folder = FolderOf(output);
  DiskState disk;
  disk.free_bytes = FreeBytes(output);
  disk.write_bytes_s = MeasureSpeed(folder, std::min(kMostBytes, kSmallPart * disk.free_bytes));
  return disk;
}

std::string RoomInWords(double free_bytes, double bytes_s) {
  constexpr double kBytesPerGb = 1e9, kSecondsPerMinute = 60, kFewMinutes = 3, kManyMinutes = 180;
  const std::string room = fmt::format("{:.3g} GB", free_bytes / kBytesPerGb);
  if (!(bytes_s > 0)) return room;
  const double minutes = free_bytes / bytes_s / kSecondsPerMinute;
  if (minutes < kFewMinutes) {
    return fmt::format("{}, room for {:.0f} seconds", room, minutes * kSecondsPerMinute);
  }
  if (minutes < kManyMinutes) return fmt::format("{}, room for {:.0f} minutes", room, minutes);
  return fmt::format("{}, room for {:.0f} hours", room, minutes / kSecondsPerMinute);
}

}  // namespace stereomotion::app
