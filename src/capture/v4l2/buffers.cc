#include "buffers.h"

#include <linux/videodev2.h>

#include <cerrno>

#include "stereomotion/core/device_error.h"

namespace stereomotion::v4l2 {
namespace {

constexpr std::uint32_t kFewestBuffers = 2;  // one is read while the next is filled

// A buffer's description for either interface; of several planes there is one (see format.cc).
struct Description {
  v4l2_buffer buffer{};
  v4l2_plane plane{};

  Description(const Node& node, std::uint32_t index) {
    buffer.type = node.buffer_type();
    buffer.memory = V4L2_MEMORY_MMAP;
    buffer.index = index;
    if (!node.capability().multiplanar) return;
    buffer.m.planes = &plane;
    buffer.length = 1;
  }
  Description(const Description&) = delete;  // it points at itself
  Description& operator=(const Description&) = delete;

  [[nodiscard]] bool planes() const { return buffer.type == V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE; }
  [[nodiscard]] std::size_t length() const { return planes() ? plane.length : buffer.length; }
  [[nodiscard]] std::int64_t map_offset() const {
    return planes() ? plane.m.mem_offset : buffer.m.offset;
  }
  [[nodiscard]] std::size_t data_begin() const { return planes() ? plane.data_offset : 0; }
  [[nodiscard]] std::size_t data_end() const {
    return planes() ? plane.bytesused : buffer.bytesused;
  }
};

std::int64_t Ns(const timeval& time) {
  constexpr std::int64_t kNsPerS = 1'000'000'000;
  constexpr std::int64_t kNsPerUs = 1'000;
  return time.tv_sec * kNsPerS + time.tv_usec * kNsPerUs;
}

int RequestBuffers(const Node& node, std::uint32_t& count) {
  v4l2_requestbuffers request{};
  request.count = count;
  request.type = node.buffer_type();
  request.memory = V4L2_MEMORY_MMAP;
  const int error = node.Try(VIDIOC_REQBUFS, &request);
  count = request.count;
  return error;
}

}  // namespace

Buffers::Buffers(const Node& node, std::uint32_t count) : node_(node) {
  std::uint32_t given = count;
  if (const int error = RequestBuffers(node_, given); error != 0) {
    throw DeviceError(UriOf(node_.path()) + ": cannot get " + std::to_string(count) +
                      " buffers (VIDIOC_REQBUFS): " + ErrorText(error));
  }
  try {
    if (given < kFewestBuffers) {
      throw DeviceError(UriOf(node_.path()) + ": the driver gives " + std::to_string(given) +
                        " buffers of " + std::to_string(count) + ", expected at least " +
                        std::to_string(kFewestBuffers) + "; lower size or rate");
    }
    for (std::uint32_t i = 0; i < given; ++i) Map(i);
  } catch (...) {
    Release();
    throw;
  }
}

Buffers::~Buffers() { Release(); }

void Buffers::Map(std::uint32_t index) {
  Description about(node_, index);
  node_.Call(VIDIOC_QUERYBUF, &about.buffer, "ask for buffer " + std::to_string(index),
             "VIDIOC_QUERYBUF");
  timestamp_flags_ =
      about.buffer.flags & (V4L2_BUF_FLAG_TIMESTAMP_MASK | V4L2_BUF_FLAG_TSTAMP_SRC_MASK);
  const std::size_t bytes = about.length();
  memory_.push_back({node_.Map(bytes, about.map_offset()), bytes});
}

void Buffers::Release() {
  for (const Memory& memory : memory_) node_.kernel().Unmap(memory.start, memory.bytes);
  memory_.clear();
  std::uint32_t none = 0;
  RequestBuffers(node_, none);  // a device that is gone refuses; then nothing is held either
}

int Buffers::Queue(std::uint32_t index) const {
  Description about(node_, index);
  return node_.Try(VIDIOC_QBUF, &about.buffer);
}

void Buffers::QueueAll() const {
  for (std::uint32_t i = 0; i < memory_.size(); ++i) {
    if (const int error = Queue(i); error != 0) {
      throw DeviceError(UriOf(node_.path()) + ": cannot hand over buffer " + std::to_string(i) +
                        " (VIDIOC_QBUF): " + ErrorText(error));
    }
  }
}

int Buffers::Dequeue(FilledBuffer& filled) const {
  Description about(node_, 0);
  if (const int error = node_.Try(VIDIOC_DQBUF, &about.buffer); error != 0) return error;
  const v4l2_buffer& buffer = about.buffer;
  if (buffer.index >= memory_.size()) return EPROTO;  // a driver's bug: no buffer of ours
  const Memory& memory = memory_[buffer.index];
  const bool sane = about.data_begin() <= about.data_end() && about.data_end() <= memory.bytes;
  filled = {buffer.index};
  filled.data = static_cast<const std::uint8_t*>(memory.start) + (sane ? about.data_begin() : 0);
  filled.bytes = sane ? about.data_end() - about.data_begin() : 0;
  filled.sequence = buffer.sequence;
  filled.timestamp_ns = Ns(buffer.timestamp);
  filled.flags = buffer.flags;
  return 0;
}

}  // namespace stereomotion::v4l2
