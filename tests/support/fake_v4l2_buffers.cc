#include <algorithm>
#include <cerrno>

#include "tests/support/fake_v4l2_calls.h"

namespace stereomotion::testing {
namespace {

bool IsPlanes(const v4l2_buffer& buffer) {
  return buffer.type == V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE;
}

std::size_t BufferBytes(const FakeDevice& device) {
  const bool grey = device.fourcc == V4L2_PIX_FMT_GREY || device.fourcc == V4L2_PIX_FMT_SRGGB8;
  const int row = device.width * (grey ? 1 : 2) + device.padding_bytes;
  return static_cast<std::size_t>(row * device.height) + device.plane_offset;
}

int Request(FakeDevice& device, v4l2_requestbuffers& request) {
  if (request.count > 0) device.buffers_asked = request.count;
  if (device.maps > 0) return -EBUSY;  // as vb2 does
  request.count = std::min(request.count, device.most_buffers);
  device.memory.assign(request.count, std::vector<std::uint8_t>(BufferBytes(device)));
  device.queued.clear();
  return 0;
}

int Describe(const FakeDevice& device, v4l2_buffer& buffer) {
  if (buffer.index >= device.memory.size()) return -EINVAL;
  const auto bytes = static_cast<__u32>(device.memory[buffer.index].size());
  if (IsPlanes(buffer)) {
    buffer.m.planes->length = bytes;
    buffer.m.planes->m.mem_offset = buffer.index;
  } else {
    buffer.length = bytes;
    buffer.m.offset = buffer.index;
  }
  buffer.flags = device.timestamp_flags;
  return 0;
}

int Deliver(FakeDevice& device, v4l2_buffer& buffer) {
  if (device.images.empty() || device.queued.empty()) return -EAGAIN;
  const FakeImage image = device.images.front();
  device.images.pop_front();
  buffer.index = device.queued.front();
  device.queued.pop_front();
  if (buffer.index >= device.memory.size()) return 0;  // a driver's bug, if a test wants it
  auto& memory = device.memory[buffer.index];
  const auto fits = std::min(image.bytes.size(), memory.size() - device.plane_offset);
  std::copy_n(image.bytes.begin(), fits, memory.begin() + device.plane_offset);
  const auto end = static_cast<__u32>(image.bytes.size() + device.plane_offset);
  buffer.sequence = image.sequence;
  buffer.flags = image.flags | device.timestamp_flags;
  buffer.timestamp = {image.timestamp_ns / 1'000'000'000,
                      image.timestamp_ns % 1'000'000'000 / 1000};
  if (IsPlanes(buffer)) {
    buffer.m.planes->bytesused = end;
    buffer.m.planes->data_offset = device.plane_offset;
  } else {
    buffer.bytesused = end;
  }
  return 0;
}

}  // namespace

int AnswerBufferCall(FakeDevice& device, std::uint64_t request, void* argument) {
  switch (request) {
    case VIDIOC_REQBUFS:
      return Request(device, *static_cast<v4l2_requestbuffers*>(argument));
    case VIDIOC_QUERYBUF:
      return Describe(device, *static_cast<v4l2_buffer*>(argument));
    case VIDIOC_QBUF:
      device.queued.push_back(static_cast<v4l2_buffer*>(argument)->index);
      return 0;
    case VIDIOC_DQBUF:
      return Deliver(device, *static_cast<v4l2_buffer*>(argument));
    case VIDIOC_STREAMON:
    case VIDIOC_STREAMOFF:
      device.streaming = request == VIDIOC_STREAMON;
      return 0;
    default:
      return 1;
  }
}

}  // namespace stereomotion::testing
