#include "tests/support/own_network.h"

#include <arpa/inet.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace stereomotion::testing {
namespace {

ifreq RequestFor(const char* interface) {
  ifreq request{};
  std::strncpy(request.ifr_name, interface, IFNAMSIZ - 1);
  return request;
}

bool SwitchOn(int socket, const char* interface) {
  ifreq request = RequestFor(interface);
  request.ifr_flags = IFF_UP | IFF_RUNNING | IFF_LOOPBACK;
  return ioctl(socket, SIOCSIFFLAGS, &request) == 0;
}

bool AddAddress(int socket, const char* interface, const char* address) {
  ifreq request = RequestFor(interface);
  sockaddr_in internet{};
  internet.sin_family = AF_INET;
  inet_pton(AF_INET, address, &internet.sin_addr);
  std::memcpy(&request.ifr_addr, &internet, sizeof internet);
  return ioctl(socket, SIOCSIFADDR, &request) == 0;
}

}  // namespace

std::string EnterOwnNetwork() {
  const int spaces = geteuid() == 0 ? CLONE_NEWNET : CLONE_NEWUSER | CLONE_NEWNET;
  if (unshare(spaces) != 0) return std::string("no network of its own: ") + std::strerror(errno);
  const int any = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const bool done = any >= 0 && SwitchOn(any, "lo") && AddAddress(any, "lo:2", "127.0.0.2");
  const std::string why = done ? "" : std::string("no loopback: ") + std::strerror(errno);
  if (any >= 0) close(any);
  return why;
}

}  // namespace stereomotion::testing
