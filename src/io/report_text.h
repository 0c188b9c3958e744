#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace stereomotion {

/// Spells any text, also bytes that are not UTF-8, as text of HTML and XML or as a quoted
/// attribute.
std::string EscapeHtml(std::string_view text);

/// Spells a number with so many significant digits, without an exponent where people need none; a
/// dash where it is not finite.
std::string Digits(double number, int significant);

/// Likewise; a dash where there is none.
std::string Digits(const std::optional<double>& number, int significant);

/// Spells a value down to the second significant digit of its standard uncertainty.
std::string ValueText(double value, double sigma);

/// Spells a number of things: 1 pair, 2 pairs.
std::string Counted(std::int64_t number, std::string_view thing);

/// Spells a place in an order: 1st, 2nd, 3rd, 4th, 11th, 21st.
std::string Ordinal(std::int64_t number);

/// Builds an HTML table row by row. Cells are HTML already.
class HtmlTable {
 public:
  /// `columns`: a letter a column, l: text on the left, r: number on the right.
  HtmlTable(std::string columns, const std::vector<std::string>& heads);

  void AddRow(const std::vector<std::string>& cells, std::string_view row_class = "");
  [[nodiscard]] std::string Text() const;

 private:
  std::string columns_;
  std::string text_;
};

}  // namespace stereomotion
