#pragma once

#include <string>
#include <vector>

#include "motion/filter_segments.h"
#include "stereomotion/motion/filter.h"

namespace stereomotion {

/// Filter the samples of each segment that a method can answer for and say in words what they did;
/// samples outside the segments stay as they are.
std::string FilterByButterworth(const PoseSeries& series,
                                const std::vector<FilterSegment>& segments,
                                const FilterOptions& options, std::vector<FilteredSample>& samples);
std::string FilterBySpline(const PoseSeries& series, const std::vector<FilterSegment>& segments,
                           std::vector<FilteredSample>& samples);
std::string FilterByRts(const PoseSeries& series, const std::vector<FilterSegment>& segments,
                        const FilterOptions& options, std::vector<FilteredSample>& samples);

}  // namespace stereomotion
