#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace stereomotion::testing {

/// Runs `stereomotion_gv_server` (the path in `program`) as long as the object lives, and no longer
/// than the thread that started it (so that a test that crashes leaves nothing behind).
class GvProcess {
 public:
  /// Waits until it serves; throws `std::runtime_error` where it does not.
  GvProcess(const std::string& program, const std::vector<std::string>& arguments);
  ~GvProcess();
  GvProcess(const GvProcess&) = delete;
  GvProcess& operator=(const GvProcess&) = delete;
  /// Kills it as a power cut would.
  void Kill();
  /// Sends a signal.
  void Signal(int signal) const;

 private:
  pid_t pid_ = -1;
};

}  // namespace stereomotion::testing
