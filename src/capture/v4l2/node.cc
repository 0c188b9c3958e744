#include "node.h"

#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "stereomotion/core/device_error.h"

namespace stereomotion::v4l2 {
namespace {

template <std::size_t kSize>
std::string Text(const __u8 (&field)[kSize]) {
  const char* begin = reinterpret_cast<const char*>(field);
  return {begin, strnlen(begin, kSize)};
}

std::string Existing(Kernel& kernel) {
  const auto nodes = kernel.VideoNodes();
  if (nodes.empty()) {
    return "there is no /dev/video at all: is the camera plugged in, and its driver loaded "
           "(`dmesg` tells)?";
  }
  std::string text = "there are";
  for (const auto& node : nodes) text += (&node == &nodes.front() ? " " : ", ") + node;
  return text + "; `stereomotion cameras` tells which are cameras";
}

std::string OpenProblem(Kernel& kernel, int error) {
  if (error == ENOENT) return "there is no such device; " + Existing(kernel);
  return "cannot be opened: " + ErrorText(error);
}

const char* Advice(int error) {
  switch (error) {
    case EBUSY:
      return "another program uses the camera: end it (`fuser -v /dev/video*` names it)";
    case EACCES:
    case EPERM:
      return "this user may not use cameras: `sudo usermod -aG video $USER`, then log in again";
    case ENODEV:
    case ENXIO:
    case EIO:
      return "it was unplugged, or its connection fails: check cable, hub and power supply";
    case ENOSPC:
      return "the USB bus has no bandwidth left for it: lower size or rate, choose a smaller pixel "
             "format, or plug the cameras into different USB controllers";
    case ENOMEM:
      return "the driver found no memory for its buffers: lower size or rate";
    case EPIPE:
    case ENOLINK:
      return "the image pipeline before it is not set up, or carries another format: set it with "
             "`media-ctl`";
    case ENOTTY:
      return "its driver does not offer that";
    default:
      return "";
  }
}

}  // namespace

std::string ErrorText(int error) {
  const std::string advice = Advice(error);
  // Not strerror: it is not safe with several threads.
  return std::system_category().message(error) + (advice.empty() ? "" : "; ") + advice;
}

std::string UriOf(const std::string& path) { return "v4l2:" + path; }

int QueryCapability(Kernel& kernel, int descriptor, Capability& capability) {
  v4l2_capability raw{};
  int result = 0;
  do {
    result = kernel.Control(descriptor, VIDIOC_QUERYCAP, &raw);
  } while (result == -EINTR);
  if (result < 0) return -result;
  // What this file can do, where the driver tells; else what the whole device can.
  const bool own = (raw.capabilities & V4L2_CAP_DEVICE_CAPS) != 0;
  const std::uint32_t can = own ? raw.device_caps : raw.capabilities;
  const bool single = (can & V4L2_CAP_VIDEO_CAPTURE) != 0;
  capability = {Text(raw.driver), Text(raw.card), Text(raw.bus_info)};
  capability.multiplanar = !single && (can & V4L2_CAP_VIDEO_CAPTURE_MPLANE) != 0;
  capability.captures = single || capability.multiplanar;
  capability.streams = (can & V4L2_CAP_STREAMING) != 0;
  return 0;
}

Node::Node(std::shared_ptr<Kernel> kernel, std::string path)
    : kernel_(std::move(kernel)), path_(std::move(path)) {
  do {
    descriptor_ = kernel_->Open(path_);
  } while (descriptor_ == -EINTR);
  if (descriptor_ < 0) throw DeviceError(UriOf(path_) + ": " + OpenProblem(*kernel_, -descriptor_));
  try {
    Identify();
  } catch (...) {
    kernel_->Close(descriptor_);
    throw;
  }
}

Node::~Node() { kernel_->Close(descriptor_); }

void Node::Identify() {
  const int error = QueryCapability(*kernel_, descriptor_, capability_);
  if (error == ENOTTY || error == EINVAL) {
    throw DeviceError(UriOf(path_) + ": is no V4L2 device; " + Existing(*kernel_));
  }
  if (error != 0) {
    throw DeviceError(UriOf(path_) +
                      ": does not say what it is (VIDIOC_QUERYCAP: " + ErrorText(error) + ")");
  }
  const std::string name = capability_.card + " (driver " + capability_.driver + ")";
  if (!capability_.captures) {
    throw DeviceError(UriOf(path_) + ": " + name +
                      " delivers no images here, this is a device file for metadata or output; "
                      "expected a camera; " +
                      Existing(*kernel_));
  }
  if (!capability_.streams) {
    throw DeviceError(UriOf(path_) + ": " + name +
                      " cannot stream into memory, expected a driver that can; take another one");
  }
}

std::uint32_t Node::buffer_type() const {
  return capability_.multiplanar ? V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE : V4L2_BUF_TYPE_VIDEO_CAPTURE;
}

int Node::Try(std::uint64_t request, void* argument) const {
  int result = 0;
  do {
    result = kernel_->Control(descriptor_, request, argument);
  } while (result == -EINTR);
  return result < 0 ? -result : 0;
}

void Node::Call(std::uint64_t request, void* argument, const std::string& what,
                const char* call) const {
  const int error = Try(request, argument);
  if (error == 0) return;
  throw DeviceError(UriOf(path_) + ": cannot " + what + " (" + call + "): " + ErrorText(error));
}

void* Node::Map(std::size_t bytes, std::int64_t offset) const {
  int error = 0;
  void* memory = kernel_->Map(descriptor_, bytes, offset, error);
  if (memory != nullptr) return memory;
  throw DeviceError(UriOf(path_) + ": cannot map a buffer of " + std::to_string(bytes) +
                    " bytes (mmap): " + ErrorText(error));
}

int Node::Wait(std::chrono::milliseconds at_most) const {
  constexpr std::int64_t kNsPerMs = 1'000'000;
  const std::int64_t until_ns = kernel_->NowNs() + at_most.count() * kNsPerMs;
  int left_ms = static_cast<int>(at_most.count());
  int result = 0;
  while ((result = kernel_->Poll(descriptor_, left_ms)) == -EINTR) {
    left_ms = static_cast<int>(std::max<std::int64_t>(0, (until_ns - kernel_->NowNs()) / kNsPerMs));
  }
  return result;
}

}  // namespace stereomotion::v4l2
