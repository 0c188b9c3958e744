#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace stereomotion::v4l2 {

/// The system calls that a V4L2 camera needs, so that a test can put a scripted kernel in their
/// place. Errors come back as −errno; nothing is retried here.
class Kernel {
 public:
  virtual ~Kernel() = default;
  /// Opens a device for non-blocking use: its file descriptor, or −errno.
  virtual int Open(const std::string& path) = 0;
  virtual void Close(int descriptor) = 0;
  /// ioctl: 0 or more, or −errno.
  virtual int Control(int descriptor, std::uint64_t request, void* argument) = 0;
  /// Maps a buffer of the device for reading; null and `error` (errno) where that fails.
  virtual void* Map(int descriptor, std::size_t bytes, std::int64_t offset, int& error) = 0;
  virtual void Unmap(void* memory, std::size_t bytes) = 0;
  /// Waits for an image: poll's events, 0 after the time, or −errno.
  virtual int Poll(int descriptor, int at_most_ms) = 0;
  /// Lists the device files /dev/video*, in the order of their numbers.
  virtual std::vector<std::string> VideoNodes() = 0;
  /// CLOCK_MONOTONIC [ns].
  virtual std::int64_t NowNs() = 0;
};

/// Gives the kernel that runs this program.
std::shared_ptr<Kernel> RunningKernel();

}  // namespace stereomotion::v4l2
