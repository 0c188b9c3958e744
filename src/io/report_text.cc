#include "report_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace stereomotion {
namespace {

constexpr const char* kNone = "–";
constexpr int kMostDecimals = 6;    // smaller numbers read better with an exponent
constexpr double kMostPlain = 1e7;  // larger ones, too

// The JSON library replaces what is not UTF-8; one decoder in a program is enough.
std::string ValidUtf8(std::string_view text) {
  using nlohmann::json;
  return json::parse(json(text).dump(-1, ' ', false, json::error_handler_t::replace))
      .get<std::string>();
}

int DecimalsFor(double number, int significant) {
  if (number == 0) return 0;
  return std::max(0, significant - 1 - static_cast<int>(std::floor(std::log10(std::abs(number)))));
}

}  // namespace

std::string EscapeHtml(std::string_view text) {
  std::string escaped;
  for (const char c : ValidUtf8(text)) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '&') {
      escaped += "&amp;";
    } else if (c == '<') {
      escaped += "&lt;";
    } else if (c == '>') {
      escaped += "&gt;";
    } else if (c == '"') {
      escaped += "&quot;";
    } else if (c == '\'') {
      escaped += "&#39;";
    } else if (code < 0x20 && c != '\t' && c != '\n') {
      escaped += "\xEF\xBF\xBD";  // XML has no control characters
    } else {
      escaped += c;
    }
  }
  return escaped;
}

std::string Digits(double number, int significant) {
  if (!std::isfinite(number)) return kNone;
  const int decimals = DecimalsFor(number, significant);
  if (decimals > kMostDecimals || std::abs(number) >= kMostPlain) {
    return fmt::format("{:.{}e}", number, significant - 1);
  }
  return fmt::format("{:.{}f}", number, decimals);
}

std::string Digits(const std::optional<double>& number, int significant) {
  return number ? Digits(*number, significant) : kNone;
}

std::string ValueText(double value, double sigma) {
  if (!std::isfinite(value)) return kNone;
  constexpr int kSigmaDigits = 2, kDigitsWithoutSigma = 6, kMost = 12;
  if (!(sigma > 0) || !std::isfinite(sigma)) return Digits(value, kDigitsWithoutSigma);
  const int decimals = std::min(kMost, DecimalsFor(sigma, kSigmaDigits));
  const double half_step = 0.5 * std::pow(10, -decimals);
  return fmt::format("{:.{}f}", std::abs(value) < half_step ? 0.0 : value, decimals);  // no "-0.00"
}

std::string Counted(std::int64_t number, std::string_view thing) {
  return fmt::format("{} {}{}", number, thing, number == 1 ? "" : "s");
}

std::string Ordinal(std::int64_t number) {
  const bool teen = number / 10 % 10 == 1;
  const std::int64_t last = teen ? 0 : number % 10;
  const char* ending = last == 1 ? "st" : last == 2 ? "nd" : last == 3 ? "rd" : "th";
  return std::to_string(number) + ending;
}

HtmlTable::HtmlTable(std::string columns, const std::vector<std::string>& heads)
    : columns_(std::move(columns)) {
  text_ = "<div class=\"wide\"><table><thead><tr>";
  for (std::size_t i = 0; i < heads.size(); ++i) {
    text_ += fmt::format("<th class=\"{}\">{}</th>", columns_.at(i), heads[i]);
  }
  text_ += "</tr></thead><tbody>\n";
}

void HtmlTable::AddRow(const std::vector<std::string>& cells, std::string_view row_class) {
  text_ += row_class.empty() ? "<tr>" : fmt::format("<tr class=\"{}\">", row_class);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    text_ += fmt::format("<td class=\"{}\">{}</td>", columns_.at(i), cells[i]);
  }
  text_ += "</tr>\n";
}

std::string HtmlTable::Text() const { return text_ + "</tbody></table></div>\n"; }

}  // namespace stereomotion
