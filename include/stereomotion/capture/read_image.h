#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "stereomotion/core/image.h"

namespace stereomotion {

/// Decodes an image file's bytes to grey, 8- or 16-bit, into `image`, reusing its memory. Returns
/// an empty text, or why it failed (then `image` is empty). A truncated or damaged file fails as a
/// whole: the decoders below would silently deliver half an image.
std::string DecodeImage(const std::vector<std::uint8_t>& bytes, Image& image);

/// Reads a whole file into `bytes`, reusing its memory. Returns an empty text, or why it failed.
std::string ReadBytes(const std::filesystem::path& file, std::vector<std::uint8_t>& bytes);

/// Tells whether a file name ends like an image that `DecodeImage` reads.
bool IsImageFile(const std::filesystem::path& file);

}  // namespace stereomotion
