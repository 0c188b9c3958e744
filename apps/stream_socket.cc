#include "stream_socket.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "stereomotion/core/output_error.h"

namespace stereomotion::app {

Descriptor::~Descriptor() {
  if (fd_ >= 0) close(fd_);
}

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  std::swap(fd_, other.fd_);
  return *this;
}

Descriptor OpenSocket(const StreamAddress& address, int type, const char* what_for,
                      const std::function<int(int fd, const addrinfo& place)>& use) {
  addrinfo hints{};
  hints.ai_socktype = type;
  hints.ai_flags = AI_PASSIVE;
  addrinfo* places = nullptr;
  const bool any = address.host == "*";
  const int failed =
      getaddrinfo(any ? nullptr : address.host.c_str(), address.port.c_str(), &hints, &places);
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> holder(places, [](addrinfo* list) {
    if (list != nullptr) freeaddrinfo(list);
  });
  std::string reason = failed != 0 ? gai_strerror(failed) : "no such address";
  for (const addrinfo* place = places; failed == 0 && place != nullptr; place = place->ai_next) {
    Descriptor made(socket(place->ai_family, type | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    if (made.ok() && use(made.get(), *place) == 0) return made;
    reason = std::strerror(errno);
  }
  throw OutputError("--stream " + address.text + ": " + what_for + ": " + reason +
                    "; expected an address of this machine and a port that is free; give another");
}

}  // namespace stereomotion::app
