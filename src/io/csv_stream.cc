#include "csv_stream.h"

#include <algorithm>
#include <charconv>

#include "csv_table.h"
#include "stereomotion/core/user_error.h"
#include "stereomotion/io/suggest.h"

namespace stereomotion {
namespace {

std::string_view Trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

}  // namespace

CsvStream::CsvStream(std::filesystem::path file, const std::string& what) : file_(std::move(file)) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file_, ignored)) {
    throw UserError(file_.string() + ": found a folder, expected " + what);
  }
  stream_.open(file_, std::ios::binary);
  if (!stream_) throw UserError(file_.string() + ": cannot be read, expected " + what);
  if (!NextLine()) throw UserError(file_.string() + ": is empty, expected " + what);
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text_.rfind(kByteOrderMark, 0) == 0) text_.erase(0, kByteOrderMark.size());
  Split();
  columns_.assign(cells_.begin(), cells_.end());
}

int CsvStream::Find(std::string_view column) const {
  const auto found = std::find(columns_.begin(), columns_.end(), column);
  return found == columns_.end() ? -1 : static_cast<int>(found - columns_.begin());
}

int CsvStream::Require(std::string_view column) const {
  const int found = Find(column);
  if (found >= 0) return found;
  const bool semicolons = columns_.size() == 1 && columns_[0].find(';') != std::string::npos;
  Fail("found no column '" + std::string(column) + "', expected it in the header" +
       (semicolons ? " (cells separated by commas)" : DidYouMean(std::string(column), columns_)));
}

std::vector<int> CsvStream::FindAll(const std::vector<std::string>& columns) const {
  std::vector<int> found;
  for (const std::string& column : columns) {
    if (const int place = Find(column); place >= 0) found.push_back(place);
  }
  if (!found.empty() && found.size() != columns.size()) {
    for (const std::string& column : columns) static_cast<void>(Require(column));
  }
  return found;
}

bool CsvStream::NextLine() {
  while (std::getline(stream_, text_)) {
    ++line_;
    const std::string_view trimmed = Trimmed(text_);
    if (!trimmed.empty() && trimmed[0] != '#') return true;
  }
  if (stream_.bad()) throw UserError(file_.string() + ": cannot be read to its end");
  return false;
}

void CsvStream::Split() {
  cells_.clear();
  if (text_.find('"') != std::string::npos) {
    SplitQuoted();
    return;
  }
  const std::string_view line = text_;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    cells_.push_back(Trimmed(line.substr(begin, end - begin)));
    begin = end + 1;
  }
}

void CsvStream::SplitQuoted() {
  unquoted_.assign(1, "");
  bool quoted = false;
  for (std::size_t i = 0; i < text_.size(); ++i) {
    const char c = text_[i];
    if (c == '"' && quoted && i + 1 < text_.size() && text_[i + 1] == '"') {
      unquoted_.back() += text_[++i];
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      unquoted_.emplace_back();
    } else if (c != '\r') {
      unquoted_.back() += c;
    }
  }
  cells_.assign(unquoted_.begin(), unquoted_.end());
}

bool CsvStream::Next() {
  if (!NextLine()) return false;
  Split();
  if (cells_.size() != columns_.size()) {
    Fail("found " + std::to_string(cells_.size()) + " cells, expected " +
         std::to_string(columns_.size()));
  }
  return true;
}

double CsvStream::Number(int column) const {
  const auto number = ParseNumber(Cell(column));
  if (!number) Fail(column, "a number");
  return *number;
}

std::int64_t CsvStream::Integer(int column) const {
  const std::string_view text = Cell(column);
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) Fail(column, "a whole number");
  return number;
}

bool CsvStream::AllEmpty(const std::vector<int>& columns) const {
  const auto empty = [&](int column) { return Cell(column).empty(); };
  if (std::all_of(columns.begin(), columns.end(), empty)) return true;
  const auto first = std::find_if(columns.begin(), columns.end(), empty);
  if (first != columns.end()) Fail(*first, "a number, as its neighbours hold");
  return false;
}

void CsvStream::Fail(const std::string& what) const {
  throw UserError(file_.string() + ":" + std::to_string(line_) + ": " + what);
}

void CsvStream::Fail(int column, const std::string& expected) const {
  const std::string_view cell = Cell(column);
  Fail(columns_[static_cast<std::size_t>(column)] + ": found " +
       (cell.empty() ? "nothing" : "'" + std::string(cell) + "'") + ", expected " + expected);
}

}  // namespace stereomotion
