#pragma once

#include <stdexcept>
#include <string>

namespace stereomotion {

/// Reports that a camera cannot be used: absent, controlled by another program, refusing a setting,
/// lost for longer than is waited. The message names the camera, what was found, what was expected
/// and what to do. The apps turn it into exit code 3.
class DeviceError : public std::runtime_error {
 public:
  explicit DeviceError(const std::string& message) : std::runtime_error(message) {}
};

}  // namespace stereomotion
