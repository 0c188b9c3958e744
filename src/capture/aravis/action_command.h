#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>

#include "gobject.h"

namespace stereomotion {

/// The keys by which cameras know that an action command is meant for them. Ours, unless the user
/// sets the camera's ActionDeviceKey, ActionGroupKey and ActionGroupMask.
struct ActionKeys {
  std::uint32_t device = 1, group = 1, mask = 1;
};

/// Tells a camera the keys to listen to, where it has features for them and the user's `controls`
/// do not set them.
ActionKeys AgreeOnActionKeys(ArvCamera* camera, const std::map<std::string, std::string>& controls);

/// Builds an action command (GigE Vision 2.0, 16.10: ACTION_CMD, to be done at once, not
/// acknowledged) for GVCP.
std::array<std::uint8_t, 20> MakeActionCommand(const ActionKeys& keys, std::uint16_t request);

/// Sends it to the camera at that IPv4 address.
void SendAction(const std::string& address, const ActionKeys& keys);

}  // namespace stereomotion
