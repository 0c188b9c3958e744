#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "stereomotion/core/median.h"
#include "stereomotion/io/run_report.h"

namespace stereomotion {

/// Computes the median of a number over the poses that a trace keeps; 0 where there are none.
template <class Get>
double MedianOf(const RunTrace& trace, const Get& get) {
  std::vector<double> numbers;
  for (const TracePoint& point : trace.points()) {
    if (point.has_pose) numbers.push_back(get(point));
  }
  return Median(std::move(numbers));
}

/// Lists the totals of the bodies; where there is one, they are those of the run.
std::vector<BodySummary> TotalsOfBodies(const RunReport& report);

/// Heads a section about one body with its name, where there are several.
std::string BodyHeading(const RunReport& report, std::size_t body, const std::string& heading);

// Each writes one section of report.html; empty where there is nothing to show.
std::string RunVerdictSection(const RunReport& report);
std::string RunWarningsSection(const RunReport& report);
std::string RunNumbersSection(const RunReport& report);
std::string RunMotionSection(const RunReport& report, std::size_t body);
std::string RunJointsSection(const RunReport& report);
std::string RunCourseSection(const RunReport& report, std::size_t body);
std::string RunPathSection(const RunReport& report, std::size_t body);
std::string RunCamerasSection(const RunReport& report);
std::string RunInputsSection(const RunReport& report);

}  // namespace stereomotion
