#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace stereomotion {

/// Writes a file so that it holds either all of `text` or what it held before: a new file beside it
/// takes the text and then its name. A symbolic link stays one, a pipe or device is written to
/// directly. Throws `OutputError`; nothing half-written is left then.
void WriteFileAtomically(const std::filesystem::path& file, std::string_view text);

struct TextFile {
  std::filesystem::path path;
  std::string text;
};

/// Writes several files that belong together: none gets its name before all are on the disk.
void WriteFilesAtomically(const std::vector<TextFile>& files);

}  // namespace stereomotion
