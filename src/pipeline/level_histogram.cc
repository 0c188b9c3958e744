#include "stereomotion/pipeline/level_histogram.h"

#include <algorithm>
#include <cmath>

namespace stereomotion {

void LevelHistogram::Add(double level) {
  const double octave = std::log2(std::max(level, 1e-9)) - kLowestOctave;
  const double last = static_cast<double>(steps_.size()) - 1;
  ++steps_[static_cast<std::size_t>(std::clamp(octave * kStepsPerOctave, 0.0, last))];
  ++count_;
}

std::optional<double> LevelHistogram::Quantile(double share) const {
  std::int64_t below = 0;
  for (std::size_t i = 0; i < steps_.size() && count_ > 0; ++i) {
    below += steps_[i];
    if (static_cast<double>(below) >= share * static_cast<double>(count_)) {
      return std::exp2((static_cast<double>(i) + 0.5) / kStepsPerOctave + kLowestOctave);
    }
  }
  return std::nullopt;
}

}  // namespace stereomotion
