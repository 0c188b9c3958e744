// How a ClockFit sees that the shortest delay of a camera has changed for good.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "clock_fit.h"

namespace stereomotion {
namespace {

/// A shortest delay that rises at once and stays so for so long has risen for good. (A clock whose
/// rate changes rises slowly.)
constexpr double kRiseNs = 16e9;
/// While the fit is younger, a third of its age is enough, but not less than this.
constexpr double kShortestRiseNs = 2e9;
constexpr double kLeastRiseNs = 200e3;
/// What falls by more than this must be seen twice.
constexpr double kLoneFallNs = 50e3;
/// A rise is so many times as great as what the delays before and after it vary by.
constexpr double kBySpreads = 8;
constexpr std::size_t kParts = 4;  ///< of the time before and after, to see what they vary by

}  // namespace

bool ClockFit::HasFallen(std::int64_t device_ns, Point& point) {
  const double line_ns = static_cast<double>(line_.HostMinusDevice(device_ns) - base_offset_ns_);
  const double fall_ns = line_ns - point.delay_ns;
  if (risen_ns_ <= 0 || fall_ns <= 0) {
    falling_ns_ = 0;
    return false;
  }
  const double before_ns = std::exchange(falling_ns_, fall_ns);
  if (before_ns <= 0 && fall_ns > kLoneFallNs) return true;  // one alone tells nothing
  const double by_ns = std::min(risen_ns_, std::max(before_ns, fall_ns));
  risen_ns_ -= by_ns;
  point.delay_ns += by_ns;
  falling_ns_ = 0;
  return false;
}

double ClockFit::LowestAbove(double from_ns, double to_ns) const {
  double lowest_ns = std::numeric_limits<double>::infinity();
  for (const Point& point : points_) {
    if (point.device_ns <= from_ns || point.device_ns > to_ns) continue;
    lowest_ns = std::min(lowest_ns, point.delay_ns - line_.slope * point.device_ns);
  }
  return lowest_ns;
}

bool ClockFit::LevelRise() {
  const double now_ns = points_.back().device_ns, age_ns = now_ns - points_.front().device_ns;
  const double part_ns = std::min(kRiseNs, age_ns / 3) / kParts;
  const double step_ns = now_ns - kParts * part_ns;
  if (kParts * part_ns < kShortestRiseNs) return false;
  std::array<double, kParts> before{}, after{};
  for (std::size_t i = 0; i < kParts; ++i) {
    const double from_ns = step_ns + static_cast<double>(i) * part_ns;
    after[i] = LowestAbove(from_ns, from_ns + part_ns);
    before[i] = LowestAbove(from_ns - kParts * part_ns, from_ns - (kParts - 1) * part_ns);
  }
  const auto low = std::minmax_element(before.begin(), before.end());
  const auto high = std::minmax_element(after.begin(), after.end());
  const double rise_ns = *high.first - *low.first;
  const double spread_ns = std::max(*low.second - *low.first, *high.second - *high.first);
  if (!std::isfinite(spread_ns) || rise_ns < std::max(kLeastRiseNs, kBySpreads * spread_ns)) {
    return false;
  }
  for (Point& point : points_) point.delay_ns -= point.device_ns > step_ns ? rise_ns : 0;
  risen_ns_ += rise_ns;
  return true;
}

}  // namespace stereomotion
