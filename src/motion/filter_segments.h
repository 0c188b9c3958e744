#pragma once

#include <cstddef>
#include <vector>

#include "stereomotion/motion/motion_data.h"

namespace stereomotion {

/// Holds a stretch of a series without long gaps; it begins and ends with a measured pose.
struct FilterSegment {
  std::vector<std::size_t> measured;  ///< indices into the series
  std::vector<double> times_s;        ///< of the measured poses, after the series' first sample
};

/// Checks what all of motion needs: times ascend strictly, measured poses are finite, their
/// rotations and free axes of unit length, their covariances symmetric and positive semi-definite.
/// Throws std::invalid_argument.
void CheckSeries(const PoseSeries& series);

/// Finds the median time between neighbouring samples; 0 for fewer than two.
double MedianPeriodS(const PoseSeries& series);

/// Splits a series where two neighbouring measured poses are farther apart than `max_gap_s` (and
/// than one and a half periods: a slow recording is not all gaps).
std::vector<FilterSegment> SplitAtGaps(const PoseSeries& series, double max_gap_s);

}  // namespace stereomotion
