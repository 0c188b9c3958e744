#include "timestamps_csv.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <locale>
#include <sstream>
#include <string>
#include <string_view>

#include "stereomotion/core/user_error.h"

namespace stereomotion {
namespace {

std::string_view Trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\xEF\xBB\xBF";  // a byte order mark counts as blank
  const auto first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

std::vector<std::string_view> SplitCells(std::string_view line) {
  std::vector<std::string_view> cells;
  for (std::size_t begin = 0;;) {
    const auto comma = line.find(',', begin);
    cells.push_back(Trimmed(line.substr(begin, comma - begin)));
    if (comma == std::string_view::npos) return cells;
    begin = comma + 1;
  }
}

class Table {
 public:
  explicit Table(const std::filesystem::path& file) : file_(file), stream_(file) {
    if (!stream_) throw UserError(file.string() + ": cannot be read");
    if (!NextLine()) Fail("an empty file", "a header line: frame,timestamp_ns");
    for (const auto cell : cells_) columns_.emplace_back(cell);
  }
  bool NextLine() {
    while (std::getline(stream_, line_)) {
      ++line_number_;
      if (Trimmed(line_).empty()) continue;
      cells_ = SplitCells(line_);
      return true;
    }
    return false;
  }
  [[nodiscard]] int Column(std::string_view name) const {
    const auto found = std::find(columns_.begin(), columns_.end(), name);
    return found == columns_.end() ? -1 : static_cast<int>(found - columns_.begin());
  }
  template <class T>
  T Number(int column) const {
    const auto& name = columns_[static_cast<std::size_t>(column)];
    if (static_cast<std::size_t>(column) >= cells_.size()) Fail("no cell", "a number in " + name);
    const std::string_view cell = cells_[static_cast<std::size_t>(column)];
    T number{};
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), number);
    if (error != std::errc() || end != cell.data() + cell.size()) {
      Fail("'" + std::string(cell) + "' in " + name,
           std::is_integral_v<T> ? "a whole number" : "a number");
    }
    return number;
  }
  [[nodiscard]] bool IsBlank(int column) const {
    return static_cast<std::size_t>(column) >= cells_.size() ||
           cells_[static_cast<std::size_t>(column)].empty();
  }
  /// Whether the line is the file's last and was not brought to its end.
  [[nodiscard]] bool IsUnended() const { return stream_.eof(); }
  [[noreturn]] void Fail(const std::string& found, const std::string& expected) const {
    throw UserError(file_.string() + ":" + std::to_string(line_number_) + ": found " + found +
                    ", expected " + expected);
  }

 private:
  std::filesystem::path file_;
  std::ifstream stream_;
  std::string line_;
  int line_number_ = 0;
  std::vector<std::string_view> cells_;
  std::vector<std::string> columns_;
};

double ReadExposure(const Table& table, int column) {
  constexpr double kLongest_us = 1e7;  // ten seconds: nothing moves in a longer one
  const auto exposure_us = table.Number<double>(column);
  // Written so that "nan" is refused, too.
  if (exposure_us >= 0 && exposure_us <= kLongest_us) return exposure_us;
  std::ostringstream found;
  found.imbue(std::locale::classic());
  found << "exposure_us " << exposure_us;
  table.Fail(found.str(), "0 to 10000000 microseconds (0 or no cell: not known)");
}

std::int64_t ReadPair(const Table& table, int column, std::int64_t& last) {
  const auto pair = table.Number<std::int64_t>(column);
  if (pair != -1 && pair <= last) {
    table.Fail("pair " + std::to_string(pair),
               "-1 (no partner), or more than the pair before (" + std::to_string(last) + ")");
  }
  last = std::max(last, pair);
  return pair;
}

/// Reads the rows one by one; each is checked against those before.
class RowReader {
 public:
  explicit RowReader(const std::filesystem::path& file) : table_(file) {
    if (frame_ < 0) table_.Fail("no column 'frame'", "frame,timestamp_ns[,exposure_us]");
    if (time_ < 0) table_.Fail("no column 'timestamp_ns'", "frame,timestamp_ns[,exposure_us]");
  }
  std::vector<FrameInfo> ReadAll() {
    while (table_.NextLine()) {
      try {
        rows_.push_back(ReadRow());
      } catch (const UserError&) {
        // A recorder, which alone writes pairs, was ended or had a full disk in that row.
        if (pair_ < 0 || !table_.IsUnended()) throw;
        break;
      }
    }
    if (rows_.empty()) table_.Fail("no rows", "a row a frame");
    return std::move(rows_);
  }

 private:
  FrameInfo ReadRow() {
    FrameInfo row{table_.Number<std::int64_t>(frame_), table_.Number<std::int64_t>(time_), 0};
    if (exposure_ >= 0 && !table_.IsBlank(exposure_)) {
      row.exposure_us = ReadExposure(table_, exposure_);
    }
    if (pair_ >= 0) row.pair = ReadPair(table_, pair_, last_pair_);
    if (row.index < 0) table_.Fail("frame " + std::to_string(row.index), "0 or more");
    if (rows_.empty()) return row;
    RequireMore("timestamp_ns", row.timestamp_ns, rows_.back().timestamp_ns);
    RequireMore("frame", row.index, rows_.back().index);
    return row;
  }
  void RequireMore(const char* name, std::int64_t value, std::int64_t before) const {
    if (value > before) return;
    table_.Fail(std::string(name) + " " + std::to_string(value),
                "more than the line before (" + std::to_string(before) + ")");
  }

  Table table_;
  const int frame_ = table_.Column("frame"), time_ = table_.Column("timestamp_ns");
  const int exposure_ = table_.Column("exposure_us"), pair_ = table_.Column("pair");
  std::int64_t last_pair_ = -1;
  std::vector<FrameInfo> rows_;
};

}  // namespace

std::string TimestampsRow(const FrameInfo& frame) {
  std::array<char, 32> exposure{};
  char* end = exposure.data();
  if (frame.exposure_us > 0) {
    end = std::to_chars(end, end + exposure.size(), frame.exposure_us).ptr;
  }
  return std::to_string(frame.index) + "," + std::to_string(frame.timestamp_ns) + "," +
         std::string(exposure.data(), end) + "," + std::to_string(frame.pair) + "\n";
}

std::vector<FrameInfo> ReadTimestamps(const std::filesystem::path& file) {
  return RowReader(file).ReadAll();
}

}  // namespace stereomotion
