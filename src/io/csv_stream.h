#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace stereomotion {

/// Reads a CSV file with a header line row by row: a long run has millions of rows, too many to
/// hold as texts. Cells may be quoted ("…", with "" for a quote). Every error is a `UserError` that
/// names file, line and column, what was found and what was expected. Lines that are empty or begin
/// with # are skipped, columns that nobody asks for are passed over.
class CsvStream {
 public:
  /// Opens a file and reads its header; `what` names what was expected of it ("the poses of a
  /// run").
  CsvStream(std::filesystem::path file, const std::string& what);

  /// Finds a column; −1: there is none of that name.
  [[nodiscard]] int Find(std::string_view column) const;
  /// Finds a column that must be there.
  [[nodiscard]] int Require(std::string_view column) const;
  /// Finds columns that must be there all together or not at all; empty: none is.
  [[nodiscard]] std::vector<int> FindAll(const std::vector<std::string>& columns) const;

  /// Goes to the next row; false: there is none.
  bool Next();
  [[nodiscard]] std::string_view Cell(int column) const {
    return cells_[static_cast<std::size_t>(column)];
  }
  [[nodiscard]] double Number(int column) const;
  [[nodiscard]] std::int64_t Integer(int column) const;
  /// Tells whether none of these cells holds anything; throws where only some do.
  [[nodiscard]] bool AllEmpty(const std::vector<int>& columns) const;
  [[noreturn]] void Fail(const std::string& what) const;
  [[noreturn]] void Fail(int column, const std::string& expected) const;

 private:
  bool NextLine();
  void Split();
  void SplitQuoted();

  std::filesystem::path file_;
  std::ifstream stream_;
  int line_ = 0;
  std::string text_;
  std::vector<std::string> columns_;
  std::vector<std::string_view> cells_;
  std::vector<std::string> unquoted_;  // what the cells of a line with quotes point into
};

}  // namespace stereomotion
