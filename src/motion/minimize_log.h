#pragma once

#include <functional>

namespace stereomotion {

/// Finds the positive number between 10^`low` and 10^`high` at which a function is least: steps of
/// half a decade, then golden section to 1 %.
double MinimizeOverDecades(const std::function<double(double)>& function, double low, double high);

}  // namespace stereomotion
