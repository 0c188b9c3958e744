#include "motion/filter_segments.h"

#include <algorithm>
#include <stdexcept>

namespace stereomotion {
namespace {

bool IsFinite(const PoseSample& sample) {
  return sample.covariance.allFinite() && sample.world_from_body.translation_mm.allFinite() &&
         sample.world_from_body.rotation.coeffs().allFinite();
}

}  // namespace

void CheckSeries(const PoseSeries& series) {
  for (std::size_t i = 0; i < series.size(); ++i) {
    if (i > 0 && series[i].timestamp_ns <= series[i - 1].timestamp_ns) {
      throw std::invalid_argument("pose series: timestamps must ascend strictly");
    }
    if (series[i].measured && !IsFinite(series[i])) {
      throw std::invalid_argument("pose series: a measured pose is not finite");
    }
  }
}

double MedianPeriodS(const PoseSeries& series) {
  if (series.size() < 2) return 0;
  std::vector<double> periods_s;
  for (std::size_t i = 1; i < series.size(); ++i) {
    periods_s.push_back(SecondsAfterFirst(series, i) - SecondsAfterFirst(series, i - 1));
  }
  const auto middle = periods_s.begin() + static_cast<std::ptrdiff_t>(periods_s.size() / 2);
  std::nth_element(periods_s.begin(), middle, periods_s.end());
  return *middle;
}

std::vector<FilterSegment> SplitAtGaps(const PoseSeries& series, double max_gap_s) {
  constexpr double kRegular = 1.5;  // periods: half way between no frame lost and one
  const double longest_s = std::max(max_gap_s, kRegular * MedianPeriodS(series));
  std::vector<FilterSegment> segments;
  for (std::size_t i = 0; i < series.size(); ++i) {
    if (!series[i].measured) continue;
    const double time_s = SecondsAfterFirst(series, i);
    if (segments.empty() || time_s - segments.back().times_s.back() > longest_s) {
      segments.emplace_back();
    }
    segments.back().measured.push_back(i);
    segments.back().times_s.push_back(time_s);
  }
  return segments;
}

}  // namespace stereomotion
