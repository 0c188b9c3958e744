#include "folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>

#include "stereomotion/core/user_error.h"

namespace stereomotion {

FolderLock::~FolderLock() {
  if (fd_ >= 0) close(fd_);
}

void FolderLock::Take(const std::filesystem::path& folder) {
  if (fd_ >= 0) return;
  fd_ = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd_ < 0 || flock(fd_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  throw UserError(folder.string() +
                  ": is still being recorded by another program; wait until that has ended");
}

}  // namespace stereomotion
