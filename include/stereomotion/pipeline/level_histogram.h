#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace stereomotion {

/// Keeps the distribution of positive levels (χ² per degree of freedom, latencies) in steps of a
/// sixteenth of an octave, so that the median of any number of them takes the same memory.
class LevelHistogram {
 public:
  void Add(double level);
  [[nodiscard]] std::int64_t count() const { return count_; }
  /// Median to 2 %; nothing while nothing was added.
  [[nodiscard]] std::optional<double> Median() const { return Quantile(0.5); }
  /// The level, to 2 %, that this share of all does not exceed; nothing while nothing was added.
  [[nodiscard]] std::optional<double> Quantile(double share) const;

 private:
  static constexpr int kStepsPerOctave = 16;
  static constexpr int kOctaves = 60;
  static constexpr int kLowestOctave = -30;
  std::vector<std::int64_t> steps_ = std::vector<std::int64_t>(kStepsPerOctave * kOctaves, 0);
  std::int64_t count_ = 0;
};

}  // namespace stereomotion
