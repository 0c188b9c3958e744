#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace stereomotion {

/// Orders names as a person does: `img2` before `img10`. A strict weak order.
bool NaturalLess(const std::string& a, const std::string& b);

/// Reads the numbers that names carry (the last run of digits before the ending). Nothing unless
/// every name has one, they ascend, and fewer than half of the numbers between are missing (names
/// may be clock times, too, which number nothing).
std::optional<std::vector<std::int64_t>> FrameNumbers(
    const std::vector<std::filesystem::path>& files);

}  // namespace stereomotion
