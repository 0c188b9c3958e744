#include "stereomotion/io/suggest.h"

#include <algorithm>

namespace stereomotion {

int EditDistance(const std::string& a, const std::string& b) {
  const std::size_t columns = b.size() + 1;
  std::vector<int> table((a.size() + 1) * columns);
  const auto at = [&](std::size_t i, std::size_t j) -> int& { return table[i * columns + j]; };
  for (std::size_t i = 0; i <= a.size(); ++i) at(i, 0) = static_cast<int>(i);
  for (std::size_t j = 0; j <= b.size(); ++j) at(0, j) = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int exchange = at(i - 1, j - 1) + (a[i - 1] == b[j - 1] ? 0 : 1);
      at(i, j) = std::min({at(i - 1, j) + 1, at(i, j - 1) + 1, exchange});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) at(i, j) = std::min(at(i, j), at(i - 2, j - 2) + 1);
    }
  }
  return at(a.size(), b.size());
}

std::string DidYouMean(const std::string& word, const std::vector<std::string>& known) {
  const std::string* best = nullptr;
  int best_distance = 0;
  for (const std::string& candidate : known) {
    const int distance = EditDistance(word, candidate);
    // A forgotten or extra ending (`fx` for `fx_px`) is nearer than its length says.
    const bool prefix =
        word.size() >= 2 &&
        (candidate.rfind(word, 0) == 0 || (candidate.size() >= 2 && word.rfind(candidate, 0) == 0));
    const int effective = prefix ? std::min(distance, 1) : distance;
    const auto longest = static_cast<int>(std::max(word.size(), candidate.size()));
    if (effective > std::max(1, longest * 2 / 5)) continue;
    if (best == nullptr || effective < best_distance) {
      best = &candidate;
      best_distance = effective;
    }
  }
  return best == nullptr ? "" : "; did you mean '" + *best + "'?";
}

}  // namespace stereomotion
