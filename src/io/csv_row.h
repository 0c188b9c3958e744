#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>

namespace stereomotion {

/// Fills one row of a CSV file cell by cell: ten significant digits and a decimal point whatever
/// the locale; what is not finite is an empty cell.
class CsvRow {
 public:
  explicit CsvRow(std::string& rows) : rows_(rows) {}
  CsvRow& Text(std::string_view text) {
    Separate();
    if (text.find_first_of(",\"\r\n") == std::string_view::npos) {
      rows_ += text;
      return *this;
    }
    rows_ += '"';
    for (const char c : text) rows_ += c == '"' ? std::string(2, c) : std::string(1, c);
    rows_ += '"';
    return *this;
  }
  CsvRow& Integer(std::int64_t number) {
    Separate();
    fmt::format_to(std::back_inserter(rows_), "{}", number);
    return *this;
  }
  // Adding 0 turns −0 into 0: two equal numbers have one spelling.
  CsvRow& Number(double number) {
    Separate();
    if (std::isfinite(number)) {
      fmt::format_to(std::back_inserter(rows_), "{:.10g}", number + 0.0);
    }
    return *this;
  }
  CsvRow& Empty(int cells = 1) {
    for (int i = 0; i < cells; ++i) Separate();
    return *this;
  }
  template <class Vector>
  CsvRow& Numbers(const Vector& numbers) {
    for (Eigen::Index i = 0; i < numbers.size(); ++i) Number(numbers[i]);
    return *this;
  }
  template <class Matrix>
  CsvRow& Upper(const Matrix& matrix) {
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
      for (Eigen::Index j = i; j < matrix.cols(); ++j) Number(matrix(i, j));
    }
    return *this;
  }
  template <class Vector>
  CsvRow& NumbersOrEmpty(const std::optional<Vector>& numbers) {
    return numbers ? Numbers(*numbers) : Empty(static_cast<int>(Vector::RowsAtCompileTime));
  }
  void End() { rows_ += '\n'; }

 private:
  void Separate() {
    if (!first_) rows_ += ',';
    first_ = false;
  }
  std::string& rows_;
  bool first_ = true;
};

}  // namespace stereomotion
