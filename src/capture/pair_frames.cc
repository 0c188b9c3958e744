#include "stereomotion/capture/pair_frames.h"

#include <algorithm>
#include <cstdlib>

namespace stereomotion {
namespace {

// Of two equally near times the earlier one wins, on both sides: ties stay one to one.
std::int64_t NearestIndex(const std::vector<std::int64_t>& times_ns, std::int64_t time_ns) {
  const auto after = std::lower_bound(times_ns.begin(), times_ns.end(), time_ns);
  if (after == times_ns.begin()) return 0;
  if (after == times_ns.end()) return static_cast<std::int64_t>(times_ns.size()) - 1;
  const auto before = after - 1;
  return (time_ns - *before <= *after - time_ns ? before : after) - times_ns.begin();
}

}  // namespace

std::int64_t MedianPeriodNs(const std::vector<std::int64_t>& times_ns) {
  if (times_ns.size() < 2) return 0;
  std::vector<std::int64_t> steps(times_ns.size() - 1);
  for (std::size_t i = 0; i < steps.size(); ++i) steps[i] = times_ns[i + 1] - times_ns[i];
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

std::vector<std::int64_t> PairByTime(const std::vector<std::int64_t>& left_ns,
                                     const std::vector<std::int64_t>& right_ns,
                                     std::int64_t tolerance_ns) {
  std::vector<std::int64_t> partner(left_ns.size(), -1);
  if (right_ns.empty()) return partner;
  for (std::size_t i = 0; i < left_ns.size(); ++i) {
    const std::int64_t j = NearestIndex(right_ns, left_ns[i]);
    const std::int64_t right_time_ns = right_ns[static_cast<std::size_t>(j)];
    if (std::llabs(right_time_ns - left_ns[i]) >= tolerance_ns) continue;
    if (NearestIndex(left_ns, right_time_ns) == static_cast<std::int64_t>(i)) partner[i] = j;
  }
  return partner;
}

}  // namespace stereomotion
