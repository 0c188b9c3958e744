#include "image_phase.h"

#include <cmath>
#include <cstdlib>

#include "stereomotion/core/median.h"

namespace stereomotion {

void ImagePhase::Compare(const std::vector<std::int64_t>& left_ns,
                         const std::vector<std::int64_t>& right_ns, std::int64_t offset_ns,
                         std::int64_t reach_ns) {
  differences_ns_.clear();
  slopes_.clear();
  std::size_t at = 0;
  std::int64_t last_ns = 0;
  for (const std::int64_t left : left_ns) {
    const auto difference = [&](std::size_t right) { return left - right_ns[right] - offset_ns; };
    while (at + 1 < right_ns.size() &&
           std::llabs(difference(at + 1)) < std::llabs(difference(at))) {
      ++at;
    }
    if (right_ns.empty() || std::llabs(difference(at)) > reach_ns) continue;
    const auto difference_ns = static_cast<double>(difference(at));
    if (!differences_ns_.empty()) {
      const auto step_ns = static_cast<double>(left - last_ns);
      slopes_.push_back((difference_ns - differences_ns_.back()) / step_ns);
    }
    last_ns = left;
    differences_ns_.push_back(difference_ns);
  }
}

double ImagePhase::MedianNs() { return MedianInPlace(differences_ns_); }

bool ImagePhase::Slide(double steepest) {
  constexpr double kSigmas = 4;
  constexpr double kSigmaOfMad = 1.4826;
  const double slope = MedianInPlace(slopes_);
  for (double& value : slopes_) value = std::abs(value - slope);
  const double sigma =
      kSigmaOfMad * MedianInPlace(slopes_) / std::sqrt(static_cast<double>(slopes_.size()));
  return std::abs(slope) > steepest && std::abs(slope) > kSigmas * sigma;
}

}  // namespace stereomotion
