#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace stereomotion {

/// Checks that an image file is whole before a decoder sees it: PNG chunk by chunk with its check
/// sums up to IEND, JPEG up to its end marker, BMP and binary PGM/PPM by their length. Returns an
/// empty text, or what is wrong.
std::string CheckImageBytes(const std::vector<std::uint8_t>& bytes);

}  // namespace stereomotion
