#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace stereomotion {

/// Checks that all strips or tiles of a TIFF's first image lie within the file (TIFF 6.0, section
/// 2). Returns an empty text, or what is wrong; BigTIFF is left to the decoder.
std::string CheckTiff(const std::vector<std::uint8_t>& bytes);

}  // namespace stereomotion
