#include "motion/minimize_log.h"

#include <algorithm>
#include <cmath>

namespace stereomotion {

double MinimizeOverDecades(const std::function<double(double)>& function, double low, double high) {
  constexpr double kStep = 0.5, kTolerance = 0.004, kGolden = 0.6180339887498949;  // decades
  const auto at = [&](double decades) { return function(std::pow(10.0, decades)); };
  double best = low, least = at(low);
  for (double x = low + kStep; x <= high + kStep / 2; x += kStep) {
    const double value = at(x);
    if (value < least) best = x, least = value;
  }
  double a = std::max(best - kStep, low), b = std::min(best + kStep, high);
  double c = b - kGolden * (b - a), d = a + kGolden * (b - a);
  double at_c = at(c), at_d = at(d);
  while (b - a > kTolerance) {
    if (at_c < at_d) {
      b = d, d = c, at_d = at_c;
      c = b - kGolden * (b - a), at_c = at(c);
    } else {
      a = c, c = d, at_c = at_d;
      d = a + kGolden * (b - a), at_d = at(d);
    }
  }
  return std::pow(10.0, (a + b) / 2);
}

}  // namespace stereomotion
