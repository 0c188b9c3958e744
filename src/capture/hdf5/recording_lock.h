#pragma once

#include <filesystem>
#include <string>

namespace stereomotion {

/// Names the file itself where `file` is a symbolic link to it.
std::filesystem::path LinkedFile(const std::filesystem::path& file);

/// Names the folder of a recording's segments: "rec.h5.segments", beside the file itself.
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

  /// Whether something kept the kernel from bringing all that was written to the disk: since the
  /// recording began the computer was started anew, the disk was taken away or it refused.
  [[nodiscard]] bool may_be_torn() const { return may_be_torn_; }
  /// The disk refused what was written: whoever repairs believes only what was noted as brought to
  /// it.
  void Distrust();
  /// Gives back the room that was kept for joining the segments on a full disk.
  void FreeReserve() const;
  /// The recording is whole: the mark is taken away.
  void Remove();

 private:
  void Write(const std::string& session);

  std::filesystem::path file_;
  int fd_ = -1;
  bool may_be_torn_ = false;
};

/// Tells whether the mark is there.
bool IsMarkedUnfinished(const std::filesystem::path& recording);

}  // namespace stereomotion
