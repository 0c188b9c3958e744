#include "check_image_bytes.h"

#include <zlib.h>

#include <cctype>
#include <cstddef>
#include <cstring>

#include "check_tiff.h"

namespace stereomotion {
namespace {

using Bytes = std::vector<std::uint8_t>;

bool StartsWith(const Bytes& bytes, const char* magic, std::size_t length) {
  return bytes.size() >= length && std::memcmp(bytes.data(), magic, length) == 0;
}

std::uint32_t BigEndian32(const std::uint8_t* p) {
  return std::uint32_t{p[0]} << 24 | std::uint32_t{p[1]} << 16 | std::uint32_t{p[2]} << 8 | p[3];
}

std::uint32_t LittleEndian32(const std::uint8_t* p) {
  return std::uint32_t{p[3]} << 24 | std::uint32_t{p[2]} << 16 | std::uint32_t{p[1]} << 8 | p[0];
}

// A chunk is length, type, data, CRC-32 of type and data (PNG specification, 5.3).
std::string CheckPng(const Bytes& bytes) {
  constexpr std::size_t kSignature = 8;
  constexpr std::size_t kOverhead = 12;
  std::size_t at = kSignature;
  while (bytes.size() - at >= kOverhead) {
    const std::uint8_t* chunk = bytes.data() + at;
    const std::size_t length = BigEndian32(chunk);
    if (length > bytes.size() - at - kOverhead) break;
    const auto crc = crc32(0, chunk + 4, static_cast<uInt>(length + 4));
    if (crc != BigEndian32(chunk + 8 + length)) return "damaged PNG (check sum)";
    if (std::memcmp(chunk + 4, "IEND", 4) == 0) return "";
    at += length + kOverhead;
  }
  return "truncated PNG (no IEND)";
}

// Some cameras pad the file with zeros behind the end marker.
std::string CheckJpeg(const Bytes& bytes) {
  std::size_t end = bytes.size();
  while (end > 2 && bytes[end - 1] == 0) --end;
  const bool ended = end >= 4 && bytes[end - 2] == 0xFF && bytes[end - 1] == 0xD9;
  return ended ? "" : "truncated JPEG (no end marker)";
}

std::string CheckBmp(const Bytes& bytes) {
  constexpr std::size_t kHeader = 54;
  if (bytes.size() < kHeader) return "truncated BMP (no header)";
  const std::size_t offset = LittleEndian32(bytes.data() + 10);
  const auto width = static_cast<std::int32_t>(LittleEndian32(bytes.data() + 18));
  const auto height = static_cast<std::int32_t>(LittleEndian32(bytes.data() + 22));
  const std::size_t bits = bytes[28] | std::size_t{bytes[29]} << 8;
  const bool compressed = LittleEndian32(bytes.data() + 30) != 0;
  if (width <= 0 || height == 0) return "damaged BMP (size)";
  if (compressed) return "";
  const std::size_t row = (static_cast<std::size_t>(width) * bits + 31) / 32 * 4;
  const auto rows = static_cast<std::size_t>(height < 0 ? -std::int64_t{height} : height);
  return bytes.size() < offset + row * rows ? "truncated BMP" : "";
}

// Reads the next number of a PNM header, past blanks and comments; false at the file's end.
bool NextPnmNumber(const Bytes& bytes, std::size_t& at, std::size_t& number) {
  while (at < bytes.size() && !std::isdigit(bytes[at])) {
    if (bytes[at] == '#') {
      while (at < bytes.size() && bytes[at] != '\n') ++at;
    } else if (!std::isspace(bytes[at])) {
      return false;
    } else {
      ++at;
    }
  }
  constexpr std::size_t kLargest = 1U << 20;  // keeps the products below within range
  for (number = 0; at < bytes.size() && std::isdigit(bytes[at]); ++at) {
    number = number * 10 + (bytes[at] - '0');
    if (number > kLargest) return false;
  }
  return at < bytes.size();
}

std::string CheckBinaryPnm(const Bytes& bytes) {
  std::size_t at = 2, width = 0, height = 0, largest = 0;
  if (!NextPnmNumber(bytes, at, width) || !NextPnmNumber(bytes, at, height) ||
      !NextPnmNumber(bytes, at, largest)) {
    return "damaged PGM (header)";
  }
  const std::size_t channels = bytes[1] == '6' ? 3 : 1;
  const std::size_t pixels = width * height * channels * (largest > 255 ? 2 : 1);
  return bytes.size() < at + 1 + pixels ? "truncated PGM" : "";
}

}  // namespace

std::string CheckImageBytes(const Bytes& bytes) {
  if (bytes.empty()) return "empty file";
  if (StartsWith(bytes, "\x89PNG\r\n\x1a\n", 8)) return CheckPng(bytes);
  if (StartsWith(bytes, "\xFF\xD8\xFF", 3)) return CheckJpeg(bytes);
  if (StartsWith(bytes, "BM", 2)) return CheckBmp(bytes);
  if (StartsWith(bytes, "P5", 2) || StartsWith(bytes, "P6", 2)) return CheckBinaryPnm(bytes);
  if (StartsWith(bytes, "P2", 2) || StartsWith(bytes, "P3", 2)) return "";
  if (StartsWith(bytes, "II", 2) || StartsWith(bytes, "MM", 2)) return CheckTiff(bytes);
  return "not a PNG, TIFF, PGM, BMP or JPEG image";
}

}  // namespace stereomotion
