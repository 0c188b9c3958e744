#include "disk_calls.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <climits>

namespace stereomotion {
namespace {

// So many pieces the kernel takes in one call (UIO_MAXIOV).
constexpr int kMostPieces = 1024;

int BytesPerPixel(PixelType type) { return type == PixelType::kGray8 ? 1 : 2; }

int Allocate(int fd, off_t bytes) {
  int result = 0;
  do {
    result = fallocate(fd, 0, 0, bytes);
  } while (result != 0 && errno == EINTR);
  // Such a file system tells while writing that it is full; that is handled, too.
  return result != 0 && (errno == EOPNOTSUPP || errno == ENOSYS) ? 0 : result;
}

/// Lists the rows of an image from byte `done` on.
class Rows {
 public:
  Rows(const std::uint8_t* data, const ImageView& shape)
      : data_(data),
        shape_(shape),
        row_bytes_(static_cast<std::int64_t>(shape.width_px) * BytesPerPixel(shape.type)),
        is_one_block_(shape.stride_bytes == row_bytes_) {}
  [[nodiscard]] std::int64_t size() const { return row_bytes_ * shape_.height_px; }
  /// Fills `pieces`, returns how many.
  int From(std::int64_t done, std::array<iovec, kMostPieces>& pieces) const {
    if (is_one_block_) return Put(done, size() - done, pieces[0]);
    int count = 0;
    for (std::int64_t at = done; at < size() && count < kMostPieces; ++count) {
      const std::int64_t in_row = at % row_bytes_;
      Put(at / row_bytes_ * shape_.stride_bytes + in_row, row_bytes_ - in_row,
          pieces[static_cast<std::size_t>(count)]);
      at += row_bytes_ - in_row;
    }
    return count;
  }

 private:
  int Put(std::int64_t offset, std::int64_t bytes, iovec& piece) const {
    // iovec serves reading and writing and so knows no const.
    piece = {const_cast<std::uint8_t*>(data_) + offset, static_cast<std::size_t>(bytes)};
    return 1;
  }
  const std::uint8_t* data_;
  ImageView shape_;
  std::int64_t row_bytes_;
  bool is_one_block_;
};

// Transfers all rows by `call`, which may do a part of them; false: it failed (errno) or nothing
// comes any more (errno 0).
template <class Call>
bool Transfer(const Rows& rows, const Call& call, std::int64_t offset) {
  std::array<iovec, kMostPieces> pieces;
  for (std::int64_t done = 0; done < rows.size();) {
    const int count = rows.From(done, pieces);
    errno = 0;
    const ssize_t n = call(pieces.data(), count, offset + done);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    done += n;
  }
  return true;
}

}  // namespace

DiskCalls::DiskCalls() : write(pwritev), allocate(Allocate), sync(fdatasync), sync_all(syncfs) {}

bool WriteAt(const DiskCalls& disk, int fd, const void* data, std::int64_t bytes,
             std::int64_t offset) {
  const ImageView one_row{static_cast<const std::uint8_t*>(data), static_cast<int>(bytes), 1, bytes,
                          PixelType::kGray8};
  return WriteImageAt(disk, fd, one_row, offset);
}

bool WriteImageAt(const DiskCalls& disk, int fd, const ImageView& image, std::int64_t offset) {
  const auto write = [&](const iovec* pieces, int count, std::int64_t at) {
    return disk.write(fd, pieces, count, at);
  };
  const bool done = Transfer(Rows(image.data, image), write, offset);
  if (!done && errno == 0) errno = ENOSPC;
  return done;
}

void SyncFolderOf(const std::filesystem::path& file) {
  const std::filesystem::path folder = std::filesystem::absolute(file).parent_path();
  const int fd = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return;
  fsync(fd);
  close(fd);
}

void GiveBackRoom(int fd, std::int64_t begin, std::int64_t end) {
  constexpr std::int64_t kPageBytes = 4096;  // room is kept in pages
  const std::int64_t first = (begin + kPageBytes - 1) / kPageBytes * kPageBytes;
  if (end <= first) return;
  // Refused: the room stays taken, no harm but that.
  if (fallocate(fd, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, first, end - first) != 0) return;
}

bool ReadImageAt(int fd, int width_px, int height_px, PixelType type, std::int64_t offset,
                 Image& image) {
  image.Resize(width_px, height_px, type);
  const auto read = [&](const iovec* pieces, int count, std::int64_t at) {
    return preadv(fd, pieces, count, at);
  };
  return Transfer(Rows(image.Row<std::uint8_t>(0), image.View()), read, offset);
}

}  // namespace stereomotion
