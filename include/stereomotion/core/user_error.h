#pragma once

#include <stdexcept>
#include <string>

namespace stereomotion {

/// Reports wrong use or an invalid file: the caller of the program can mend it. The message names
/// the file, the line or key, what was found and what was expected. The apps turn it into exit
/// code 2.
class UserError : public std::runtime_error {
 public:
  explicit UserError(const std::string& message) : std::runtime_error(message) {}
};

}  // namespace stereomotion
