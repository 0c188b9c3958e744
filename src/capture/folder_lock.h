#pragma once

#include <filesystem>

namespace stereomotion {

/// Keeps a second recorder out of a folder (flock on the folder itself, so that nothing stays
/// behind).
class FolderLock {
 public:
  FolderLock() = default;
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  /// Takes the lock where there is such a folder and the file system has locks. Throws `UserError`
  /// where another recorder holds it.
  void Take(const std::filesystem::path& folder);

 private:
  int fd_ = -1;
};

}  // namespace stereomotion
