#include "stereomotion/io/row_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "stereomotion/core/output_error.h"

namespace stereomotion {

RowFile::RowFile(const std::filesystem::path& file)
    : file_(file), fd_(open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)) {
  if (fd_ < 0) throw OutputError(file.string() + ": cannot be written: " + std::strerror(errno));
}

RowFile::~RowFile() { close(fd_); }

void RowFile::Append(std::string_view rows) {
  std::size_t written = 0;
  while (written < rows.size()) {
    const ssize_t n = write(fd_, rows.data() + written, rows.size() - written);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) {
      const std::string reason = n < 0 ? std::strerror(errno) : "the disk takes no more";
      CutBackTo(size_bytes_);
      throw OutputError(file_.string() + ": cannot be written: " + reason);
    }
    written += static_cast<std::size_t>(n);
  }
  size_bytes_ += static_cast<std::int64_t>(rows.size());
}

void RowFile::Overwrite(std::string_view content) {
  const auto wanted = static_cast<std::int64_t>(content.size());
  // Takes missing room first: where the disk refuses it, the old content is still whole.
  if (wanted > size_bytes_)
    Append(std::string(static_cast<std::size_t>(wanted - size_bytes_), ' '));
  lseek(fd_, 0, SEEK_SET);
  size_bytes_ = 0;
  Append(content);
  CutBackTo(size_bytes_);
}

void RowFile::CutBackTo(std::int64_t size_bytes) noexcept {
  if (ftruncate(fd_, size_bytes) != 0) return;
  lseek(fd_, size_bytes, SEEK_SET);
  size_bytes_ = size_bytes;
}

}  // namespace stereomotion
