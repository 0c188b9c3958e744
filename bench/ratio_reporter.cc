#include "bench/ratio_reporter.h"

#include <algorithm>
#include <cstdio>

#include "stereomotion/core/median.h"

namespace stereomotion::bench {
namespace {

/// Gives what stands between the slash and an underscore after it: hot or streaming.
std::string GroupOf(const std::string& name) {
  const std::size_t begin = name.find('/') + 1;
  return begin == 0 ? "" : name.substr(begin, name.find('_', begin) - begin);
}

}  // namespace

bool RatioReporter::ReportContext(const Context& /*context*/) { return true; }

void RatioReporter::ReportRuns(const std::vector<Run>& runs) {
  for (const Run& run : runs) {
    if (run.run_type != Run::RT_Iteration || run.error_occurred) continue;
    const std::string& name = run.run_name.function_name;
    times_ms_[name].push_back(run.cpu_accumulated_time / static_cast<double>(run.iterations) * 1e3);
  }
}

void RatioReporter::Finalize() {
  std::printf("%-32s %10s %6s %14s\n", "benchmark", "median ms", "runs",
              ("/ " + reference_).c_str());
  for (const auto& [name, times_ms] : times_ms_) {
    const double median_ms = Median(times_ms);
    const auto reference = times_ms_.find(reference_ + "/" + GroupOf(name));
    std::printf("%-32s %10.4f %6zu", name.c_str(), median_ms, times_ms.size());
    if (reference != times_ms_.end()) std::printf(" %14.2f", median_ms / Median(reference->second));
    std::printf("\n");
  }
}

}  // namespace stereomotion::bench
