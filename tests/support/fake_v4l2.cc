#include "tests/support/fake_v4l2.h"

#include <poll.h>

#include <cerrno>
#include <cstring>

#include "tests/support/fake_v4l2_calls.h"

namespace stereomotion::testing {
namespace {

int Take(std::deque<int>& failures) {
  if (failures.empty()) return 0;
  const int error = failures.front();
  failures.pop_front();
  return error;
}

int AnswerCapability(const FakeDevice& device, void* argument) {
  auto& capability = *static_cast<v4l2_capability*>(argument);
  const auto copy = [](__u8* to, const std::string& text) {
    std::memcpy(to, text.c_str(), text.size() + 1);
  };
  copy(capability.driver, device.driver);
  copy(capability.card, device.card);
  copy(capability.bus_info, device.bus);
  capability.capabilities = V4L2_CAP_DEVICE_CAPS | device.capabilities;
  capability.device_caps = device.capabilities;
  return 0;
}

}  // namespace

int FakeKernel::Open(const std::string& path) {
  if (const int error = Take(open_failures); error != 0) return -error;
  if (devices.count(path) == 0) return -ENOENT;
  open_[next_] = path;
  return next_++;
}

void FakeKernel::Close(int descriptor) { open_.erase(open_.find(descriptor)); }

int FakeKernel::Control(int descriptor, std::uint64_t request, void* argument) {
  if (const int error = Take(failures[request]); error != 0) return -error;
  const auto found = devices.find(open_.at(descriptor));
  if (found == devices.end()) return -ENODEV;
  FakeDevice& device = found->second;
  if (request == VIDIOC_QUERYCAP) return AnswerCapability(device, argument);
  int answer = AnswerFormatCall(device, request, argument);
  if (answer > 0) answer = AnswerControlCall(device, request, argument);
  if (answer > 0) answer = AnswerBufferCall(device, request, argument);
  return answer > 0 ? -ENOTTY : answer;
}

void* FakeKernel::Map(int descriptor, std::size_t bytes, std::int64_t offset, int& error) {
  error = Take(map_failures);
  if (error != 0) return nullptr;
  const std::string& path = open_.at(descriptor);
  FakeDevice& device = devices.at(path);
  auto& memory = device.memory.at(static_cast<std::size_t>(offset));
  if (memory.size() != bytes) {
    error = EINVAL;
    return nullptr;
  }
  ++device.maps;
  mapped_[memory.data()] = path;
  return memory.data();
}

void FakeKernel::Unmap(void* memory, std::size_t /*bytes*/) {
  const auto found = mapped_.find(memory);
  if (devices.count(found->second) > 0) --devices[found->second].maps;
  mapped_.erase(found);
}

int FakeKernel::Poll(int descriptor, int at_most_ms) {
  if (const int error = Take(poll_failures); error != 0) return -error;
  const auto found = devices.find(open_.at(descriptor));
  if (found == devices.end()) return POLLERR | POLLHUP;
  const FakeDevice& device = found->second;
  if (device.poll_events >= 0) return device.poll_events;
  if (device.streaming && !device.images.empty() && !device.queued.empty()) return POLLIN;
  constexpr std::int64_t kNsPerMs = 1'000'000;
  now_ns += at_most_ms * kNsPerMs;
  return 0;
}

std::vector<std::string> FakeKernel::VideoNodes() {
  std::vector<std::string> nodes;
  for (const auto& device : devices) nodes.push_back(device.first);
  return nodes;
}

}  // namespace stereomotion::testing
