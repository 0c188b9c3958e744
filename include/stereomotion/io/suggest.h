#pragma once

#include <string>
#include <vector>

namespace stereomotion {

/// Counts the insertions, deletions, exchanges and swaps of neighbours that lead from `a` to `b`
/// (optimal string alignment distance, Damerau 1964).
int EditDistance(const std::string& a, const std::string& b);

/// Phrases the nearest of `known` as "; did you mean 'fx_px'?", or nothing where none is near.
std::string DidYouMean(const std::string& word, const std::vector<std::string>& known);

}  // namespace stereomotion
