#include "number_text.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace stereomotion {

std::string NumberText(double number) {
  if (!std::isfinite(number)) throw std::invalid_argument("NumberText: a number is not finite");
  // Denormal numbers are rounding errors, and yaml-cpp reads them as none.
  if (std::abs(number) < std::numeric_limits<double>::min()) return "0";
  return fmt::format("{}", number);
}

std::string QuotedText(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (c == '\n') {
      quoted += "\\n";
    } else if (c == '\t') {
      quoted += "\\t";
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      quoted += ' ';  // no other control character means anything in a name or path
    } else {
      quoted += c;
    }
  }
  return quoted + '"';
}

}  // namespace stereomotion
