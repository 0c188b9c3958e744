#include "action_command.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>

namespace stereomotion {
namespace {

constexpr std::uint16_t kGvcpPort = 3956;

// The device key can often be written but not read: what the user sets must be known from there.
std::uint32_t AgreeOn(ArvCamera* camera, const std::map<std::string, std::string>& controls,
                      const char* feature, std::uint32_t ours) {
  if (const auto set = controls.find(feature); set != controls.end()) {
    constexpr int kAnyBase = 0;  // 0x… too
    return static_cast<std::uint32_t>(std::strtoul(set->second.c_str(), nullptr, kAnyBase));
  }
  if (arv_camera_is_feature_available(camera, feature, nullptr) != 0) {
    arv_camera_set_integer(camera, feature, ours, nullptr);
  }
  return ours;
}

void Put32(std::uint8_t* at, std::uint32_t value) {
  value = htonl(value);
  std::memcpy(at, &value, sizeof value);
}

}  // namespace

ActionKeys AgreeOnActionKeys(ArvCamera* camera,
                             const std::map<std::string, std::string>& controls) {
  ActionKeys keys;
  keys.device = AgreeOn(camera, controls, "ActionDeviceKey", keys.device);
  keys.group = AgreeOn(camera, controls, "ActionGroupKey", keys.group);
  keys.mask = AgreeOn(camera, controls, "ActionGroupMask", keys.mask);
  return keys;
}

std::array<std::uint8_t, 20> MakeActionCommand(const ActionKeys& keys, std::uint16_t request) {
  constexpr std::uint8_t kKey = 0x42;
  constexpr std::uint8_t kNoFlags = 0;  // no acknowledgement: the image is one
  std::array<std::uint8_t, 20> packet{kKey, kNoFlags, 0x01, 0x00, 0x00, 12};
  packet[6] = static_cast<std::uint8_t>(request >> 8);
  packet[7] = static_cast<std::uint8_t>(request & 0xFF);
  Put32(packet.data() + 8, keys.device);
  Put32(packet.data() + 12, keys.group);
  Put32(packet.data() + 16, keys.mask);
  return packet;
}

void SendAction(const std::string& address, const ActionKeys& keys) {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(kGvcpPort);
  if (inet_pton(AF_INET, address.c_str(), &to.sin_addr) != 1) return;
  const int any = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (any < 0) return;
  const auto packet = MakeActionCommand(keys, 1);
  sendto(any, packet.data(), packet.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
  close(any);
}

}  // namespace stereomotion
