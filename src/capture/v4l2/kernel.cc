#include "kernel.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <filesystem>

namespace stereomotion::v4l2 {
namespace {

constexpr char kFolder[] = "/dev";
constexpr char kPrefix[] = "video";

// Gives the number of "video12", or −1.
int NodeNumber(const std::string& name) {
  constexpr std::size_t kLength = sizeof(kPrefix) - 1;
  constexpr std::size_t kMostDigits = 6;  // fits an int; Linux gives at most 3
  if (name.rfind(kPrefix, 0) != 0 || name.size() == kLength) return -1;
  const std::string digits = name.substr(kLength, kMostDigits);
  const bool all = std::all_of(digits.begin(), digits.end(),
                               [](unsigned char c) { return std::isdigit(c) != 0; });
  return all ? std::stoi(digits) : -1;
}

class LinuxKernel : public Kernel {
 public:
  int Open(const std::string& path) override {
    return Result(::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC));
  }
  void Close(int descriptor) override { ::close(descriptor); }
  int Control(int descriptor, std::uint64_t request, void* argument) override {
    return Result(::ioctl(descriptor, request, argument));
  }
  void* Map(int descriptor, std::size_t bytes, std::int64_t offset, int& error) override {
    void* memory = ::mmap(nullptr, bytes, PROT_READ, MAP_SHARED, descriptor, offset);
    if (memory != MAP_FAILED) return memory;
    error = errno;
    return nullptr;
  }
  void Unmap(void* memory, std::size_t bytes) override { ::munmap(memory, bytes); }
  int Poll(int descriptor, int at_most_ms) override {
    pollfd wait{descriptor, POLLIN, 0};
    const int ready = Result(::poll(&wait, 1, at_most_ms));
    return ready > 0 ? wait.revents : ready;
  }
  std::vector<std::string> VideoNodes() override {
    std::vector<std::pair<int, std::string>> found;
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(kFolder, none)) {
      const int number = NodeNumber(entry.path().filename().string());
      if (number >= 0) found.emplace_back(number, entry.path().string());
    }
    std::sort(found.begin(), found.end());
    std::vector<std::string> paths;
    paths.reserve(found.size());
    for (const auto& node : found) paths.push_back(node.second);
    return paths;
  }
  std::int64_t NowNs() override {
    const auto now = std::chrono::steady_clock::now().time_since_epoch();  // CLOCK_MONOTONIC
    return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
  }

 private:
  static int Result(int result) { return result < 0 ? -errno : result; }
};

}  // namespace

std::shared_ptr<Kernel> RunningKernel() { return std::make_shared<LinuxKernel>(); }

}  // namespace stereomotion::v4l2
