#include "number_within.h"

#include <fmt/format.h>

#include <charconv>
#include <string>

namespace stereomotion::app {
namespace {

template <class T>
CLI::Validator Within(T lowest, T highest, const char* kind) {
  const std::string expected = fmt::format("{} from {} to {}", kind, lowest, highest);
  const auto check = [=](std::string& text) -> std::string {
    T number{};
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, number);
    // Written so that "nan" is refused, too.
    if (error == std::errc() && stop == end && number >= lowest && number <= highest) return "";
    return fmt::format("found '{}', expected {}", text, expected);
  };
  return {check, fmt::format("{}..{}", lowest, highest)};
}

}  // namespace

CLI::Validator NumberWithin(double lowest, double highest) {
  return Within(lowest, highest, "a number");
}

CLI::Validator NotEmpty(const std::string& what) {
  const auto check = [what](std::string& text) -> std::string {
    return text.empty() ? "found an empty text, expected " + what : "";
  };
  return {check, ""};
}

CLI::Validator WholeNumberWithin(std::int64_t lowest, std::int64_t highest) {
  return Within(lowest, highest, "a whole number");
}

}  // namespace stereomotion::app
