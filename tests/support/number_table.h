#pragma once

#include <filesystem>
#include <vector>

#include "stereomotion/core/image.h"

namespace stereomotion::testing {

/// Reads the rows of a table of numbers: blanks or commas between them; lines that begin with
/// anything else (headings) are left out. Throws std::runtime_error where there is no such file.
std::vector<std::vector<double>> ReadNumbers(const std::filesystem::path& file);

/// Reads an image file to grey. Throws std::runtime_error where that fails.
Image ReadGrey(const std::filesystem::path& file);

}  // namespace stereomotion::testing
