#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <vector>

#include "disk_calls.h"
#include "segment_layout.h"
#include "stereomotion/core/pair_source.h"

namespace stereomotion {

/// Writes one segment of a recording in place, from several threads. A row counts from the moment
/// its `frame` cell is written, which is last. Destroyed without `Close` it stays as after a crash.
class SegmentWriter {
 public:
  /// Creates the file and takes its room on the disk; it gets its name only when it is whole.
  /// Throws `OutputError`, then nothing of it is left.
  SegmentWriter(std::filesystem::path file, std::vector<SegmentCamera> cameras,
                const DiskCalls& disk);
  ~SegmentWriter();
  SegmentWriter(const SegmentWriter&) = delete;
  SegmentWriter& operator=(const SegmentWriter&) = delete;

  [[nodiscard]] const std::vector<SegmentCamera>& cameras() const { return cameras_; }
  [[nodiscard]] const std::filesystem::path& file() const { return file_; }

  /// Writes the image of a row; the row is not valid by it. Throws `OutputError`.
  void WriteImage(std::size_t camera, std::int64_t row, const ImageView& image);
  /// Makes a row valid whose image is written. Throws `OutputError`.
  void Commit(std::size_t camera, std::int64_t row, const Frame& frame, std::int64_t pair);
  /// Brings to the disk what is written and notes there how much that is: after a power cut only
  /// that is believed, for the kernel writes in any order. Throws `OutputError`.
  void Sync();
  /// Synchronises and gives back the room that was not used.
  void Close();

 private:
  void SyncOrFail();
  void Write(const void* data, std::int64_t bytes, std::int64_t offset);
  [[noreturn]] void Fail(const char* what) const;
  void Open();
  [[nodiscard]] std::vector<std::int64_t> CommittedWithoutGap();
  void GiveBack(std::size_t camera);

  std::filesystem::path file_;
  std::vector<SegmentCamera> cameras_;
  const DiskCalls& disk_;
  std::vector<SegmentOffsets> offsets_;
  int fd_ = -1;
  // After a refusal the kernel may forget what it could not write and call the next try a success.
  bool is_lost_ = false;
  std::mutex mutex_;  // guards what follows
  std::vector<std::vector<bool>> committed_;
};

}  // namespace stereomotion
