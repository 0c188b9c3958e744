#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace stereomotion {

/// Reads a finite number that fills the whole text, with a decimal point whatever the locale.
std::optional<double> ParseNumber(std::string_view text);

/// Splits a line at its commas; blanks around the cells are left out.
std::vector<std::string> SplitCells(std::string_view line);

/// Splits a text into its lines, without their ends (LF or CRLF).
std::vector<std::string> SplitLines(std::string_view text);

/// Holds a CSV file with a header line. Every error is a `UserError` that names file, line and
/// column, what was found and what was expected. Lines that are empty or begin with # are skipped.
class CsvTable {
 public:
  /// Reads a file whose columns, in any order, are all of `required` and any of `optional`.
  static CsvTable Load(const std::filesystem::path& file, const std::vector<std::string>& required,
                       const std::vector<std::string>& optional = {});

  [[nodiscard]] std::size_t size() const { return rows_.size(); }
  [[nodiscard]] bool Has(const std::string& column) const;
  [[nodiscard]] const std::string& Text(std::size_t row, const std::string& column) const;
  [[nodiscard]] double Number(std::size_t row, const std::string& column) const;
  [[nodiscard]] int Integer(std::size_t row, const std::string& column, int smallest,
                            int largest) const;
  [[noreturn]] void Fail(std::size_t row, const std::string& column, const std::string& found,
                         const std::string& expected) const;
  [[nodiscard]] const std::filesystem::path& file() const { return file_; }

 private:
  struct Row {
    int line = 0;  // from 1
    std::vector<std::string> cells;
  };
  void ReadHeader(const Row& header, const std::vector<std::string>& required,
                  const std::vector<std::string>& optional);
  [[nodiscard]] std::string Place(int line) const;
  [[nodiscard]] std::size_t Column(const std::string& column) const;

  std::filesystem::path file_;
  std::vector<std::string> columns_;
  std::vector<Row> rows_;
};

}  // namespace stereomotion
