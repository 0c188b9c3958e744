#pragma once

#include <filesystem>
#include <string>

namespace stereomotion {

/// Names the folder of a recording's segments: "rec.h5.segments".
std::filesystem::path SegmentFolder(const std::filesystem::path& recording);

/// Marks a recording as being written: a file in the segments' folder that is there until the
/// recording is finished or repaired, and locked (flock) by the program that writes. A crash leaves
/// the file without its lock.
class RecordingLock {
 public:
  enum class Use { kRecord, kRepair };
  /// Takes the lock; for `kRecord` the file is made. Throws `UserError` where another program
  /// holds it, `OutputError` where the disk refuses.
  RecordingLock(const std::filesystem::path& recording, Use use);
  ~RecordingLock();
  RecordingLock(const RecordingLock&) = delete;
  RecordingLock& operator=(const RecordingLock&) = delete;

  /// Whether the computer was started anew since the recording began: then the kernel had no time
  /// to bring all that was written to the disk.
  [[nodiscard]] bool is_from_earlier_boot() const { return earlier_boot_; }
  /// Gives back the room that was kept for joining the segments on a full disk.
  void FreeReserve() const;
  /// The recording is whole: the mark is taken away.
  void Remove();

 private:
  void Write(const std::string& boot);

  std::filesystem::path file_;
  int fd_ = -1;
  bool earlier_boot_ = false;
};

/// Tells whether the mark is there.
bool IsMarkedUnfinished(const std::filesystem::path& recording);

}  // namespace stereomotion
