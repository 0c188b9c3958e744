#include "stereomotion/io/write_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

#include "stereomotion/io/output_error.h"

namespace stereomotion {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void Fail(const fs::path& file, int error) {
  throw OutputError(file.string() + ": cannot be written: " + std::strerror(error));
}

// Returns errno, 0 for success. What is synchronised is on the disk: some file systems tell only
// then that they are full.
int WriteAll(int fd, std::string_view text, bool sync) {
  while (!text.empty()) {
    const ssize_t n = write(fd, text.data(), text.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return errno;
    if (n == 0) return ENOSPC;
    text.remove_prefix(static_cast<std::size_t>(n));
  }
  return sync && fsync(fd) != 0 ? errno : 0;
}

int WriteTo(const fs::path& file, int flags, std::string_view text, bool sync) {
  const int fd = open(file.c_str(), flags | O_WRONLY | O_CLOEXEC, 0666);
  if (fd < 0) return errno;
  const int error = WriteAll(fd, text, sync);
  const bool closed = close(fd) == 0;
  return error != 0 || closed ? error : errno;
}

}  // namespace

void WriteFileAtomically(const fs::path& file, std::string_view text) {
  std::error_code none;
  const fs::file_status status = fs::status(file, none);
  if (fs::is_directory(status)) Fail(file, EISDIR);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    if (const int error = WriteTo(file, 0, text, false)) Fail(file, error);
    return;
  }
  const fs::path target = fs::exists(status) ? fs::canonical(file, none) : file;
  fs::path part = target;
  part += ".part" + std::to_string(getpid());
  int error = WriteTo(part, O_CREAT | O_TRUNC, text, true);
  // Overwriting keeps who may read the file.
  if (error == 0 && fs::exists(status)) fs::permissions(part, status.permissions(), none);
  if (error == 0 && std::rename(part.c_str(), target.c_str()) != 0) error = errno;
  if (error == 0) return;
  unlink(part.c_str());
  Fail(file, error);
}

}  // namespace stereomotion
