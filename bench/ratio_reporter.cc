#include "bench/ratio_reporter.h"

#include <algorithm>
#include <cstdio>

namespace stereomotion::bench {
namespace {

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

bool RatioReporter::ReportContext(const Context& /*context*/) { return true; }

void RatioReporter::ReportRuns(const std::vector<Run>& runs) {
  for (const Run& run : runs) {
    if (run.run_type != Run::RT_Iteration || run.error_occurred) continue;
    const std::string& name = run.run_name.function_name;
    times_ms_[name].push_back(run.real_accumulated_time / static_cast<double>(run.iterations) *
                              1e3);
  }
}

void RatioReporter::Finalize() {
  const auto reference = times_ms_.find(reference_);
  const double unit_ms = reference == times_ms_.end() ? 0 : Median(reference->second);
  std::printf("%-44s %10s %6s %12s\n", "benchmark", "median ms", "runs",
              ("/ " + reference_).c_str());
  for (const auto& [name, times_ms] : times_ms_) {
    const double median_ms = Median(times_ms);
    std::printf("%-44s %10.4f %6zu", name.c_str(), median_ms, times_ms.size());
    std::printf(unit_ms > 0 ? " %12.2f\n" : "\n", median_ms / unit_ms);
  }
}

}  // namespace stereomotion::bench
