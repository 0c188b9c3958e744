#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace stereomotion {

/// Finds how two cameras' images lie to each other in time. Keeps its memory.
class ImagePhase {
 public:
  /// Compares every left image with the right one that lies nearest to it, given the offset left −
  /// right of the clocks; those farther apart than `reach_ns` do not count. Both lists ascend.
  void Compare(const std::vector<std::int64_t>& left_ns, const std::vector<std::int64_t>& right_ns,
               std::int64_t offset_ns, std::int64_t reach_ns);
  /// Images that were compared.
  [[nodiscard]] std::size_t size() const { return differences_ns_.size(); }
  /// Median of left − right − offset; reorders what was compared.
  double MedianNs();
  /// Tells whether the images slide against each other faster than `steepest` (ns a ns), which no
  /// clocks' drift explains. Triggers by command jitter, so the median must stand out of the
  /// spread.
  bool Slide(double steepest);

 private:
  std::vector<double> differences_ns_;
  std::vector<double> slopes_;
};

}  // namespace stereomotion
