#include "src/capture/aravis/receive_buffer.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

namespace stereomotion {
namespace {

/// A UDP socket at an address of this computer alone.
class LocalSocket {
 public:
  LocalSocket(const char* address, std::uint16_t port) {
    bound_.sin_family = AF_INET;
    bound_.sin_port = htons(port);
    inet_pton(AF_INET, address, &bound_.sin_addr);
    socklen_t size = sizeof bound_;
    auto* name = reinterpret_cast<sockaddr*>(&bound_);
    ready_ = bind(descriptor_, name, size) == 0 && getsockname(descriptor_, name, &size) == 0;
  }
  ~LocalSocket() { close(descriptor_); }
  LocalSocket(const LocalSocket&) = delete;
  LocalSocket& operator=(const LocalSocket&) = delete;

  bool ready() const { return ready_; }
  const sockaddr_in& bound() const { return bound_; }
  std::uint16_t port() const { return ntohs(bound_.sin_port); }
  int BufferBytes() const {
    int bytes = 0;
    socklen_t size = sizeof bytes;
    getsockopt(descriptor_, SOL_SOCKET, SO_RCVBUF, &bytes, &size);
    return bytes;
  }
  void MakeSmall() const {
    const int bytes = 4096;
    setsockopt(descriptor_, SOL_SOCKET, SO_RCVBUF, &bytes, sizeof bytes);
  }

 private:
  int descriptor_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in bound_{};
  bool ready_ = false;
};

TEST(ReceiveBuffer, OfTwoSocketsWithOnePortOnlyThatOfTheAddressIsEnlarged) {
  const LocalSocket first("127.0.0.1", 0);
  const LocalSocket second("127.0.0.2", first.port());
  ASSERT_TRUE(first.ready() && second.ready());
  for (const LocalSocket* wanted : {&first, &second}) {
    first.MakeSmall();
    second.MakeSmall();
    const LocalSocket& other = wanted == &first ? second : first;
    const int before = other.BufferBytes();
    const std::int64_t held = EnlargeReceiveBuffer(wanted->bound());
    EXPECT_EQ(held, wanted->BufferBytes() / 2);
    EXPECT_GT(wanted->BufferBytes(), before);
    EXPECT_EQ(other.BufferBytes(), before);
  }
}

TEST(ReceiveBuffer, NoSuchSocketHoldsNothing) {
  sockaddr_in nowhere{};
  {
    const LocalSocket closed("127.0.0.1", 0);
    nowhere = closed.bound();
  }
  EXPECT_EQ(EnlargeReceiveBuffer(nowhere), 0);
}

}  // namespace
}  // namespace stereomotion
