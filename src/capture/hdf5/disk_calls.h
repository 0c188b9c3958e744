#pragma once

#include <sys/types.h>
#include <sys/uio.h>

#include <cstdint>
#include <filesystem>
#include <functional>

#include "stereomotion/core/image.h"

namespace stereomotion {

/// The calls with which a recording reaches the disk; tests put slow and full disks here. Each
/// fails as its system call does, with errno.
struct DiskCalls {
  DiskCalls();
  std::function<ssize_t(int fd, const iovec* pieces, int count, off_t offset)> write;
  /// Takes room for `bytes` from the start of the file on; succeeds where the file system cannot.
  std::function<int(int fd, off_t bytes)> allocate;
  std::function<int(int fd)> sync;
  /// Brings all of the file system to the disk on which the file is.
  std::function<int(int fd)> sync_all;
};

/// Writes `bytes` at `offset`. False: errno tells why.
bool WriteAt(const DiskCalls& disk, int fd, const void* data, std::int64_t bytes,
             std::int64_t offset);

/// Writes the pixels of an image, row after row without gaps, at `offset`. False: errno tells why.
bool WriteImageAt(const DiskCalls& disk, int fd, const ImageView& image, std::int64_t offset);

/// Brings the names in a file's folder to the disk, as far as the file system can.
void SyncFolderOf(const std::filesystem::path& file);

/// Gives back the room of a file's bytes, where the file system can; they read as zeros then.
void GiveBackRoom(int fd, std::int64_t begin, std::int64_t end);

/// Reads the rows of an image of that size from `offset` on into `image`. False: errno tells why,
/// 0 that the file ends before.
bool ReadImageAt(int fd, int width_px, int height_px, PixelType type, std::int64_t offset,
                 Image& image);

}  // namespace stereomotion
