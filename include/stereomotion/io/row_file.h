#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace stereomotion {

/// Writes a text file of rows that is valid at every moment: what is appended reaches the file
/// whole or not at all, in one call of the system, past no buffer of the program.
class RowFile {
 public:
  /// Creates the file, or empties it. Throws `OutputError`.
  explicit RowFile(const std::filesystem::path& file);
  ~RowFile();
  RowFile(const RowFile&) = delete;
  RowFile& operator=(const RowFile&) = delete;

  /// Appends whole rows. Where the disk takes only a part of them the file is cut back to its end
  /// before, and `OutputError` is thrown.
  void Append(std::string_view rows);

  /// Replaces all that the file holds, in place: needs no room beyond the file's present size.
  void Overwrite(std::string_view content);

  [[nodiscard]] std::int64_t size_bytes() const { return size_bytes_; }
  /// Cuts the file back to an earlier size: takes the last rows back. Never throws.
  void CutBackTo(std::int64_t size_bytes) noexcept;

 private:
  std::filesystem::path file_;
  int fd_ = -1;
  std::int64_t size_bytes_ = 0;
};

}  // namespace stereomotion
