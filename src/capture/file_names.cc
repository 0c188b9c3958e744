#include "file_names.h"

#include <algorithm>
#include <cctype>
#include <numeric>

namespace stereomotion {
namespace {

bool IsDigit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

// Reads the run of digits at `at` without its leading zeros, and steps behind it.
std::string TakeDigits(const std::string& text, std::size_t& at) {
  const std::size_t begin = at;
  while (at < text.size() && IsDigit(text[at])) ++at;
  std::size_t first = begin;
  while (first + 1 < at && text[first] == '0') ++first;
  return text.substr(first, at - first);
}

std::optional<std::int64_t> FrameNumber(const std::filesystem::path& file) {
  const std::string stem = file.stem().string();
  std::size_t end = stem.size();
  while (end > 0 && !IsDigit(stem[end - 1])) --end;
  std::size_t begin = end;
  while (begin > 0 && IsDigit(stem[begin - 1])) --begin;
  const std::string digits = TakeDigits(stem, begin);
  constexpr std::size_t kMostDigits = 18;  // fits 64 bits
  if (digits.empty() || digits.size() > kMostDigits) return std::nullopt;
  return std::stoll(digits);
}

}  // namespace

bool NaturalLess(const std::string& a, const std::string& b) {
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (IsDigit(a[i]) && IsDigit(b[j])) {
      const std::string first = TakeDigits(a, i), second = TakeDigits(b, j);
      if (first.size() != second.size()) return first.size() < second.size();
      if (first != second) return first < second;
    } else if (a[i] != b[j]) {
      return a[i] < b[j];
    } else {
      ++i, ++j;
    }
  }
  const bool a_ends = i == a.size(), b_ends = j == b.size();
  if (a_ends && b_ends) return a < b;  // equal but for leading zeros
  return a_ends;
}

std::optional<std::vector<std::int64_t>> FrameNumbers(
    const std::vector<std::filesystem::path>& files) {
  std::vector<std::int64_t> numbers;
  std::int64_t step = 0;
  for (const auto& file : files) {
    const auto number = FrameNumber(file);
    if (!number || (!numbers.empty() && *number <= numbers.back())) return std::nullopt;
    if (!numbers.empty()) step = std::gcd(step, *number - numbers.back());
    numbers.push_back(*number);
  }
  if (numbers.size() < 2) return numbers;
  const auto expected = (numbers.back() - numbers.front()) / step + 1;
  if (expected > 2 * static_cast<std::int64_t>(numbers.size())) return std::nullopt;
  return numbers;
}

}  // namespace stereomotion
