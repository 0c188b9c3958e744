#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

namespace stereomotion {

/// Says how a file keeps numbers of several bytes.
enum class ByteOrder {
  kIntel,  ///< low byte first, IEEE floats
  kDec,    ///< low byte first, VAX F floats
  kMips,   ///< high byte first, IEEE floats
};

/// Holds a whole binary file and reads numbers at given places; a place beyond its end is a
/// `UserError` that names file and byte.
class BinaryFile {
 public:
  /// Reads the file; `what` names what was expected of it.
  BinaryFile(std::filesystem::path file, const std::string& what);
  /// Takes the bytes of a file that is in memory already.
  static BinaryFile Of(std::string bytes, const std::filesystem::path& name);

  void SetOrder(ByteOrder order) { order_ = order; }
  [[nodiscard]] std::size_t size() const { return bytes_.size(); }
  [[nodiscard]] std::uint8_t Byte(std::size_t at) const;
  [[nodiscard]] std::uint16_t Word(std::size_t at) const;
  [[nodiscard]] std::int16_t SignedWord(std::size_t at) const;
  [[nodiscard]] float Float(std::size_t at) const;
  [[nodiscard]] std::string Text(std::size_t at, std::size_t length) const;
  [[noreturn]] void Fail(const std::string& what) const;

 private:
  BinaryFile() = default;
  void Need(std::size_t at, std::size_t length) const;

  std::filesystem::path file_;
  std::string bytes_;
  ByteOrder order_ = ByteOrder::kIntel;
};

}  // namespace stereomotion
