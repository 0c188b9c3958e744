#pragma once

#include <netdb.h>
#include <sys/socket.h>

#include <functional>
#include <memory>
#include <string>

#include "stream_address.h"

namespace stereomotion::app {

/// Closes a file descriptor at its end.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor();
  Descriptor(Descriptor&& other) noexcept : fd_(other.fd_) { other.fd_ = -1; }
  Descriptor& operator=(Descriptor&& other) noexcept;
  [[nodiscard]] int get() const { return fd_; }
  [[nodiscard]] bool ok() const { return fd_ >= 0; }

 private:
  int fd_ = -1;
};

/// Makes a socket for each address that host and port mean, until `use` is content with one (it
/// returns 0 as `bind` and `connect` do). Throws `OutputError` with the last reason.
Descriptor OpenSocket(const StreamAddress& address, int type, const char* what_for,
                      const std::function<int(int fd, const addrinfo& place)>& use);

}  // namespace stereomotion::app
