#pragma once

#include <filesystem>
#include <string_view>

namespace stereomotion {

/// Writes a file so that it holds either all of `text` or what it held before: a new file beside it
/// takes the text and then its name. A symbolic link stays one, a pipe or device is written to
/// directly. Throws `OutputError`; nothing half-written is left then.
void WriteFileAtomically(const std::filesystem::path& file, std::string_view text);

}  // namespace stereomotion
