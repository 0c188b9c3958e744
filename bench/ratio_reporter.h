#pragma once

#include <benchmark/benchmark.h>

#include <map>
#include <string>
#include <vector>

namespace stereomotion::bench {

/// Prints the median processor time (which other programs disturb least) of every benchmark's
/// repetitions, and its ratio to the median of `reference`
/// of the same group in the same run: machines differ and are noisy, ratios less so. The benchmark
/// `Name/group_…` belongs to `group`.
class RatioReporter : public benchmark::BenchmarkReporter {
 public:
  explicit RatioReporter(std::string reference) : reference_(std::move(reference)) {}
  bool ReportContext(const Context& context) override;
  void ReportRuns(const std::vector<Run>& runs) override;
  void Finalize() override;

 private:
  std::string reference_;
  std::map<std::string, std::vector<double>> times_ms_;
};

}  // namespace stereomotion::bench
