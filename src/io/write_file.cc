#include "stereomotion/io/write_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

#include "stereomotion/core/output_error.h"

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

// A text on the disk that still lacks its name; none where the target is a device.
struct Part {
  fs::path part, target;
};

Part Prepare(const fs::path& file, std::string_view text) {
  std::error_code none;
  const fs::file_status status = fs::status(file, none);
  if (fs::is_directory(status)) Fail(file, EISDIR);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    if (const int error = WriteTo(file, 0, text, false)) Fail(file, error);
    return {};
  }
  Part part;
  part.target = fs::exists(status) ? fs::canonical(file, none) : file;
  part.part = part.target;
  part.part += ".part" + std::to_string(getpid());
  if (const int error = WriteTo(part.part, O_CREAT | O_TRUNC, text, true)) {
    unlink(part.part.c_str());
    Fail(file, error);
  }
  // Overwriting keeps who may read the file.
  if (fs::exists(status)) fs::permissions(part.part, status.permissions(), none);
  return part;
}

void Discard(const std::vector<Part>& parts) {
  for (const Part& part : parts) {
    if (!part.part.empty()) unlink(part.part.c_str());
  }
}

}  // namespace

void WriteFilesAtomically(const std::vector<TextFile>& files) {
  std::vector<Part> parts;
  try {
    for (const TextFile& file : files) parts.push_back(Prepare(file.path, file.text));
  } catch (...) {
    Discard(parts);
    throw;
  }
  for (const Part& part : parts) {
    if (part.part.empty() || std::rename(part.part.c_str(), part.target.c_str()) == 0) continue;
    const int error = errno;
    Discard(parts);  // those that have their name already are no longer there to discard
    Fail(part.target, error);
  }
}

void WriteFileAtomically(const fs::path& file, std::string_view text) {
  WriteFilesAtomically({{file, std::string(text)}});
}

}  // namespace stereomotion
