#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "kernel.h"

namespace stereomotion::v4l2 {

/// What a device says of itself (VIDIOC_QUERYCAP).
struct Capability {
  std::string driver, card, bus;
  bool captures = false;     ///< images of one or several memory planes
  bool multiplanar = false;  ///< speaks the multi-planar interface only
  bool streams = false;      ///< into mapped memory
};

/// Holds one open device file and closes it. Interrupted calls (EINTR) are made again.
class Node {
 public:
  /// Opens a device that can capture and stream. Throws `DeviceError`: absent (the message lists
  /// those that exist), not permitted, no V4L2 device, no camera.
  Node(std::shared_ptr<Kernel> kernel, std::string path);
  ~Node();
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] const Capability& capability() const { return capability_; }
  [[nodiscard]] Kernel& kernel() const { return *kernel_; }
  /// V4L2_BUF_TYPE_VIDEO_CAPTURE or its multi-planar sister.
  [[nodiscard]] std::uint32_t buffer_type() const;

  /// Makes an ioctl: 0, or errno.
  int Try(std::uint64_t request, void* argument) const;
  /// Makes an ioctl that must succeed; else throws `DeviceError`: cannot `what` (`call`: why).
  void Call(std::uint64_t request, void* argument, const std::string& what, const char* call) const;
  /// Maps a buffer. Throws `DeviceError`.
  void* Map(std::size_t bytes, std::int64_t offset) const;
  /// Waits for an image: poll's events, 0 after the time, or −errno.
  int Wait(std::chrono::milliseconds at_most) const;

 private:
  void Identify();

  std::shared_ptr<Kernel> kernel_;
  std::string path_;
  int descriptor_ = -1;
  Capability capability_;
};

/// Reads what any V4L2 device says of itself: 0, or errno.
int QueryCapability(Kernel& kernel, int descriptor, Capability& capability);

/// Says what an errno of a V4L2 call means and what to do: "Device or resource busy; …".
std::string ErrorText(int error);

/// Gives the name under which the camera at that path is opened: "v4l2:/dev/video0".
std::string UriOf(const std::string& path);

}  // namespace stereomotion::v4l2
