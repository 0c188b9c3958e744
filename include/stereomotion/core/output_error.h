#pragma once

#include <stdexcept>
#include <string>

namespace stereomotion {

/// Reports that a result could not be written: disk full, no permission. The apps turn it into exit
/// code 3.
class OutputError : public std::runtime_error {
 public:
  explicit OutputError(const std::string& message) : std::runtime_error(message) {}
};

}  // namespace stereomotion
