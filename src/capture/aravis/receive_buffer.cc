#include "receive_buffer.h"

#include <sys/socket.h>

#include <cstdlib>
#include <filesystem>

namespace stereomotion {
namespace {

bool IsBoundTo(int descriptor, const sockaddr_in& wanted) {
  sockaddr_in address{};
  socklen_t size = sizeof address;
  int type = 0;
  socklen_t type_size = sizeof type;
  return getsockopt(descriptor, SOL_SOCKET, SO_TYPE, &type, &type_size) == 0 &&
         type == SOCK_DGRAM &&
         getsockname(descriptor, reinterpret_cast<sockaddr*>(&address), &size) == 0 &&
         address.sin_family == AF_INET && address.sin_port == wanted.sin_port &&
         address.sin_addr.s_addr == wanted.sin_addr.s_addr;
}

// Aravis does not give its socket away.
int FindSocket(const sockaddr_in& wanted) {
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", ignored)) {
    const int descriptor = std::atoi(entry.path().filename().c_str());
    if (IsBoundTo(descriptor, wanted)) return descriptor;
  }
  return -1;
}

}  // namespace

std::int64_t EnlargeReceiveBuffer(const sockaddr_in& bound_to) {
  const int descriptor = FindSocket(bound_to);
  if (descriptor < 0) return 0;
  int bytes = kReceiveBuffer_bytes;
  if (setsockopt(descriptor, SOL_SOCKET, SO_RCVBUFFORCE, &bytes, sizeof bytes) != 0) {
    setsockopt(descriptor, SOL_SOCKET, SO_RCVBUF, &bytes, sizeof bytes);
  }
  socklen_t size = sizeof bytes;
  if (getsockopt(descriptor, SOL_SOCKET, SO_RCVBUF, &bytes, &size) != 0) return 0;
  return bytes / 2;  // the kernel tells twice what was asked for: socket(7)
}

std::string ReceiveBufferWarning(const std::string& uri, std::int64_t bytes) {
  if (bytes >= kReceiveBuffer_bytes) return "";
  return uri + ": the kernel limits the receive buffer to " + std::to_string(bytes >> 10) +
         " KiB; images will be incomplete whenever this computer is busy. As root: "
         "sysctl -w net.core.rmem_max=" +
         std::to_string(kReceiveBuffer_bytes);
}

}  // namespace stereomotion
