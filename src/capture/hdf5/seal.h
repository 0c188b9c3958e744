#pragma once

#include <filesystem>

namespace stereomotion {

/// Appends the SHA-256 of a file to it. HDF5 leaves bytes behind its own alone, but believes
/// whatever a damaged file says and may crash for it: what we write is checked before it is read.
/// Throws `OutputError`.
void Seal(const std::filesystem::path& file);

/// Tells whether a file bears a seal that does not fit its contents. A file without is not broken.
bool IsSealBroken(const std::filesystem::path& file);

/// Tells whether a file bears a seal that fits: nothing was cut off or changed since.
bool IsSealWhole(const std::filesystem::path& file);

}  // namespace stereomotion
