#include "src/capture/aravis/action_command.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tests/live/aravis_case.h"

namespace stereomotion::testing {
namespace {

// The bytes of the standard: key, flags, command, length, request, three keys, big endian.
TEST(ActionCommand, BytesAreThoseOfTheStandard) {
  const std::array<std::uint8_t, 20> expected{0x42, 0x00, 0x01, 0x00, 0x00, 0x0C, 0x12,
                                              0x34, 0xDE, 0xAD, 0xBE, 0xEF, 0,    0,
                                              0,    7,    0xFF, 0xFF, 0xFF, 0xFF};
  EXPECT_EQ(MakeActionCommand({0xDEADBEEF, 7, 0xFFFFFFFF}, 0x1234), expected);
}

class ActionOnNetwork : public AravisCase {};

TEST_F(ActionOnNetwork, GoesToTheControlPortOfTheCamera) {
  const int camera = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(3956);
  inet_pton(AF_INET, "127.0.0.2", &address.sin_addr);
  ASSERT_EQ(bind(camera, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  const timeval patience{5, 0};
  setsockopt(camera, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  SendAction("127.0.0.2", {1, 2, 3});
  std::array<std::uint8_t, 20> received{};
  EXPECT_EQ(recv(camera, received.data(), received.size(), 0), 20);
  EXPECT_EQ(received, MakeActionCommand({1, 2, 3}, 1));
  close(camera);
}

}  // namespace
}  // namespace stereomotion::testing
