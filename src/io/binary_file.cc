#include "binary_file.h"

#include <cstring>
#include <fstream>
#include <ios>

#include "stereomotion/core/user_error.h"

namespace stereomotion {

BinaryFile::BinaryFile(std::filesystem::path file, const std::string& what)
    : file_(std::move(file)) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file_, error)) {
    throw UserError(file_.string() + ": found no file, expected " + what);
  }
  std::ifstream stream(file_, std::ios::binary);
  const auto size = std::filesystem::file_size(file_, error);
  if (!stream || error) throw UserError(file_.string() + ": cannot be read, expected " + what);
  bytes_.resize(size);
  stream.read(bytes_.data(), static_cast<std::streamsize>(size));
  if (static_cast<std::uintmax_t>(stream.gcount()) != size) {
    throw UserError(file_.string() + ": cannot be read to its end, expected " + what);
  }
}

BinaryFile BinaryFile::Of(std::string bytes, const std::filesystem::path& name) {
  BinaryFile file;
  file.file_ = name;
  file.bytes_ = std::move(bytes);
  return file;
}

void BinaryFile::Need(std::size_t at, std::size_t length) const {
  if (at <= bytes_.size() && length <= bytes_.size() - at) return;
  Fail("ends at byte " + std::to_string(bytes_.size()) + ", expected " + std::to_string(length) +
       " bytes at " + std::to_string(at) + " (cut short or damaged)");
}

std::uint8_t BinaryFile::Byte(std::size_t at) const {
  Need(at, 1);
  return static_cast<std::uint8_t>(bytes_[at]);
}

std::uint16_t BinaryFile::Word(std::size_t at) const {
  Need(at, 2);
  const unsigned first = static_cast<std::uint8_t>(bytes_[at]);
  const unsigned second = static_cast<std::uint8_t>(bytes_[at + 1]);
  return static_cast<std::uint16_t>(order_ == ByteOrder::kMips ? first << 8U | second
                                                               : second << 8U | first);
}

std::int16_t BinaryFile::SignedWord(std::size_t at) const {
  return static_cast<std::int16_t>(Word(at));
}

// A VAX F float is an IEEE one with its halves exchanged, and four times as large.
float BinaryFile::Float(std::size_t at) const {
  Need(at, 4);
  const std::uint32_t first = Word(at), second = Word(at + 2);
  const std::uint32_t bits =
      order_ == ByteOrder::kIntel ? second << 16U | first : first << 16U | second;
  float number = 0;
  std::memcpy(&number, &bits, sizeof(number));
  constexpr float kDecScale = 4;
  return order_ == ByteOrder::kDec ? number / kDecScale : number;
}

std::string BinaryFile::Text(std::size_t at, std::size_t length) const {
  Need(at, length);
  return bytes_.substr(at, length);
}

void BinaryFile::Fail(const std::string& what) const {
  throw UserError(file_.string() + ": " + what);
}

}  // namespace stereomotion
