#include "csv_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "read_text.h"
#include "stereomotion/core/user_error.h"
#include "stereomotion/io/suggest.h"

namespace stereomotion {
namespace {

std::string Trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return "";
  return std::string(text.substr(first, text.find_last_not_of(" \t\r") - first + 1));
}

std::string Joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ",") + word;
  return text;
}

bool Contains(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

}  // namespace

std::optional<double> ParseNumber(std::string_view text) {
  if (!text.empty() && text[0] == '+') text.remove_prefix(1);
  double number = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || stop != end || !std::isfinite(number)) return std::nullopt;
  return number;
}

std::vector<std::string> SplitCells(std::string_view line) {
  std::vector<std::string> cells;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    cells.push_back(Trimmed(line.substr(begin, end - begin)));
    begin = end + 1;
  }
  return cells;
}

std::vector<std::string> SplitLines(std::string_view text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    lines.push_back(Trimmed(text.substr(begin, end - begin)));
    begin = end + 1;
  }
  return lines;
}

std::string CsvTable::Place(int line) const { return file_.string() + ":" + std::to_string(line); }

void CsvTable::ReadHeader(const Row& header, const std::vector<std::string>& required,
                          const std::vector<std::string>& optional) {
  std::vector<std::string> known = required;
  known.insert(known.end(), optional.begin(), optional.end());
  for (const std::string& column : header.cells) {
    if (!Contains(known, column)) {
      const bool semicolons = column.find(';') != std::string::npos;
      throw UserError(Place(header.line) + ": found the column '" + column +
                      "', expected columns among " + Joined(known) +
                      (semicolons ? " (separated by commas)" : DidYouMean(column, known)));
    }
    if (Contains(columns_, column)) {
      throw UserError(Place(header.line) + ": the column '" + column + "' stands here twice");
    }
    columns_.push_back(column);
  }
  for (const std::string& column : required) {
    if (Contains(columns_, column)) continue;
    throw UserError(Place(header.line) + ": the column '" + column + "' is missing, expected " +
                    Joined(required));
  }
}

CsvTable CsvTable::Load(const std::filesystem::path& file, const std::vector<std::string>& required,
                        const std::vector<std::string>& optional) {
  CsvTable table;
  table.file_ = file;
  int line = 0;
  for (const std::string& text : SplitLines(ReadText(file, "a CSV file"))) {
    ++line;
    if (text.empty() || text[0] == '#') continue;
    Row row{line, SplitCells(text)};
    if (table.columns_.empty()) {
      table.ReadHeader(row, required, optional);
      continue;
    }
    if (row.cells.size() != table.columns_.size()) {
      throw UserError(table.Place(line) + ": found " + std::to_string(row.cells.size()) +
                      " cells, expected " + std::to_string(table.columns_.size()));
    }
    table.rows_.push_back(std::move(row));
  }
  if (table.rows_.empty()) {
    throw UserError(file.string() + ": holds no rows, expected the header " + Joined(required) +
                    " and a row for each point");
  }
  return table;
}

bool CsvTable::Has(const std::string& column) const { return Contains(columns_, column); }

std::size_t CsvTable::Column(const std::string& column) const {
  return static_cast<std::size_t>(std::find(columns_.begin(), columns_.end(), column) -
                                  columns_.begin());
}

const std::string& CsvTable::Text(std::size_t row, const std::string& column) const {
  const std::string& text = rows_[row].cells.at(Column(column));
  if (text.empty()) Fail(row, column, "nothing", "a text");
  return text;
}

double CsvTable::Number(std::size_t row, const std::string& column) const {
  const std::string& text = rows_[row].cells.at(Column(column));
  const auto number = ParseNumber(text);
  if (!number) Fail(row, column, "'" + text + "'", "a number");
  return *number;
}

int CsvTable::Integer(std::size_t row, const std::string& column, int smallest, int largest) const {
  const double number = Number(row, column);
  if (number != std::floor(number) || number < smallest || number > largest) {
    Fail(row, column, "'" + rows_[row].cells.at(Column(column)) + "'",
         "a whole number from " + std::to_string(smallest) + " to " + std::to_string(largest));
  }
  return static_cast<int>(number);
}

void CsvTable::Fail(std::size_t row, const std::string& column, const std::string& found,
                    const std::string& expected) const {
  throw UserError(Place(rows_[row].line) + ": " + column + ": found " + found + ", expected " +
                  expected);
}

}  // namespace stereomotion
