#include "check_tiff.h"

#include <algorithm>
#include <cstddef>
#include <optional>

namespace stereomotion {
namespace {

constexpr unsigned kStripOffsets = 273, kStripCounts = 279, kTileOffsets = 324, kTileCounts = 325;
constexpr unsigned kShort = 3;

// Reads numbers in the file's byte order; nothing beyond the file's end.
class TiffReader {
 public:
  explicit TiffReader(const std::vector<std::uint8_t>& bytes)
      : bytes_(bytes), little_(!bytes.empty() && bytes[0] == 'I') {}

  [[nodiscard]] std::optional<std::uint64_t> Number(std::uint64_t at, unsigned size) const {
    if (at + size > bytes_.size()) return std::nullopt;
    std::uint64_t value = 0;
    for (unsigned i = 0; i < size; ++i) {
      value = value << 8 | bytes_[static_cast<std::size_t>(at + (little_ ? size - 1 - i : i))];
    }
    return value;
  }

  // Reads a directory entry's list of SHORT or LONG; up to four bytes stand in the entry itself.
  [[nodiscard]] std::optional<std::vector<std::uint64_t>> List(std::uint64_t entry) const {
    const auto type = Number(entry + 2, 2), count = Number(entry + 4, 4);
    if (!type || !count) return std::nullopt;
    const unsigned size = *type == kShort ? 2 : 4;
    if (*count * size > bytes_.size()) return std::nullopt;
    const auto begin = *count * size <= 4 ? std::optional(entry + 8) : Number(entry + 8, 4);
    std::vector<std::uint64_t> values;
    for (std::uint64_t i = 0; begin && i < *count; ++i) {
      const auto value = Number(*begin + i * size, size);
      if (!value) return std::nullopt;
      values.push_back(*value);
    }
    return values;
  }

 private:
  const std::vector<std::uint8_t>& bytes_;
  bool little_;
};

}  // namespace

std::string CheckTiff(const std::vector<std::uint8_t>& bytes) {
  const TiffReader reader(bytes);
  constexpr unsigned kClassic = 42;
  if (reader.Number(2, 2).value_or(0) != kClassic) return "";
  const std::uint64_t directory = reader.Number(4, 4).value_or(bytes.size());
  const auto entries = reader.Number(directory, 2);
  if (!entries) return "truncated TIFF (no directory)";
  std::vector<std::uint64_t> offsets, counts;
  for (std::uint64_t i = 0; i < *entries; ++i) {
    const std::uint64_t entry = directory + 2 + 12 * i;
    const auto tag = reader.Number(entry, 2);
    if (!tag) return "truncated TIFF (directory)";
    const bool is_offsets = *tag == kStripOffsets || *tag == kTileOffsets;
    const bool is_counts = *tag == kStripCounts || *tag == kTileCounts;
    if (!is_offsets && !is_counts) continue;
    const auto list = reader.List(entry);
    if (!list) return "truncated TIFF (directory)";
    (is_offsets ? offsets : counts) = *list;
  }
  for (std::size_t i = 0; i < std::min(offsets.size(), counts.size()); ++i) {
    if (offsets[i] + counts[i] > bytes.size()) return "truncated TIFF";
  }
  return "";
}

}  // namespace stereomotion
