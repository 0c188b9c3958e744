#include "stereomotion/motion/filter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "motion/butterworth_rows.h"
#include "motion/filter_methods.h"

namespace stereomotion {
namespace {

/// Starts with every frame a gap.
std::vector<FilteredSample> EmptySamples(const PoseSeries& series) {
  std::vector<FilteredSample> samples(series.size());
  for (std::size_t i = 0; i < series.size(); ++i) {
    samples[i].pose.frame = series[i].frame;
    samples[i].pose.timestamp_ns = series[i].timestamp_ns;
  }
  return samples;
}

/// Finds the largest distance of a measured pose from the nearest point of its segment's grid.
double LargestJitterS(const std::vector<FilterSegment>& segments, double period_s) {
  double largest_s = 0;
  for (const FilterSegment& segment : segments) {
    for (const double time_s : segment.times_s) {
      const double since_s = time_s - segment.times_s.front();
      const double off_s = since_s - std::round(since_s / period_s) * period_s;
      largest_s = std::max(largest_s, std::abs(off_s));
    }
  }
  return largest_s;
}

/// Says how many measured poses got no answer, and how irregular the frames are.
std::string Caveats(const PoseSeries& series, const std::vector<FilteredSample>& samples) {
  int unanswered = 0, filled = 0;
  for (std::size_t i = 0; i < series.size(); ++i) {
    if (series[i].measured && samples[i].status == MotionStatus::kGap) ++unanswered;
    if (samples[i].status == MotionStatus::kFilled) ++filled;
  }
  std::string text;
  if (filled > 0) text += fmt::format("; {} frames filled", filled);
  if (unanswered > 0) {
    text += fmt::format("; {} poses in stretches too short for the filter, left empty", unanswered);
  }
  return text;
}

/// Takes the accelerations out that lie so near a segment's ends that the point reflection there,
/// which has none at the end itself, decides on them.
void DropEndAccelerations(const PoseSeries& series, const FilterSegment& segment,
                          double half_width_s, std::vector<FilteredSample>& samples) {
  for (std::size_t i = segment.measured.front(); i <= segment.measured.back(); ++i) {
    const double time_s = SecondsAfterFirst(series, i);
    const double to_end_s =
        std::min(time_s - segment.times_s.front(), segment.times_s.back() - time_s);
    if (to_end_s >= half_width_s) continue;
    BodyVelocity& velocity = samples[i].velocity;
    velocity.has_acceleration = false;
    velocity.alpha_rad_s2.setZero();
    velocity.acceleration_mm_s2.setZero();
    velocity.covariance.rightCols<6>().setZero();
    velocity.covariance.bottomRows<6>().setZero();
  }
}

}  // namespace

std::string FilterByButterworth(const PoseSeries& series,
                                const std::vector<FilterSegment>& segments,
                                const FilterOptions& options,
                                std::vector<FilteredSample>& samples) {
  constexpr double kNotableJitter = 0.02;  // of a period: beyond any camera's own clock
  const double period_s = MedianPeriodS(series);
  const auto sections = DesignZeroPhaseButterworth(options.order, options.cutoff_hz, 1 / period_s);
  for (const FilterSegment& segment : segments) {
    const ButterworthRows rows(sections, segment, period_s);
    if (!rows.LongEnough()) continue;
    for (std::size_t i = segment.measured.front(); i <= segment.measured.back(); ++i) {
      const WeightRow row = rows.At(SecondsAfterFirst(series, i));
      samples[i] = ApplyWeights(series, segment, i, row, row);
    }
    const double half_width_s = 1 / (2 * options.cutoff_hz);  // of the impulse's main lobe
    DropEndAccelerations(series, segment, half_width_s, samples);
  }
  std::string text = fmt::format(
      "Butterworth low pass, zero phase (forward and backward), order {} and -3 dB at {:g} Hz of "
      "both passes together, at {:.6g} frames/s",
      options.order, options.cutoff_hz, 1 / period_s);
  const double jitter_s = LargestJitterS(segments, period_s);
  if (jitter_s > kNotableJitter * period_s) {
    text += fmt::format("; timestamps irregular by up to {:.3g} ms, resampled by local cubics",
                        1e3 * jitter_s);
  }
  return text;
}

FilteredSeries FilterPoses(const PoseSeries& series, const FilterOptions& options) {
  CheckSeries(series);
  if (!(options.max_gap_s >= 0)) throw std::invalid_argument("FilterPoses: max_gap_s is negative");
  if (series.size() < 2) throw std::invalid_argument("FilterPoses: fewer than two frames");
  FilteredSeries out{EmptySamples(series), ""};
  const std::vector<FilterSegment> segments = SplitAtGaps(series, options.max_gap_s);
  switch (options.method) {
    case FilterMethod::kButterworth:
      out.description = FilterByButterworth(series, segments, options, out.samples);
      break;
    case FilterMethod::kSpline:
      out.description = FilterBySpline(series, segments, out.samples);
      break;
    case FilterMethod::kRts:
      out.description = FilterByRts(series, segments, options, out.samples);
      break;
  }
  out.description += fmt::format("; gaps up to {:g} s filled", options.max_gap_s);
  out.description += Caveats(series, out.samples);
  return out;
}

}  // namespace stereomotion
