#pragma once

#include <filesystem>
#include <string>

namespace stereomotion {

/// Reads a whole text file, without a byte order mark; `what` names what was expected ("a YAML
/// file") in the `UserError` of a file that cannot be read.
std::string ReadText(const std::filesystem::path& file, const std::string& what);

}  // namespace stereomotion
