// Compares the centres of the three detectors and of four of OpenCV's means with the truth and with
// the Cramér–Rao bound, over generated balls. What is measured and what came out: docs/accuracy.md.
#include <fmt/format.h>
#include <fmt/os.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <opencv2/core.hpp>
#include <thread>

#include "bench/accuracy_run.h"

namespace stereomotion::bench {
namespace {

void WriteRow(const ConditionResult& result, const MethodResult& method, fmt::ostream& file) {
  const Condition& c = result.condition;
  const CenterScore& s = method.score;
  file.print("{},{},{},{},{},", c.sweep, c.diameter_px, c.snr_db, c.smear_diameters,
             c.hidden_fraction);
  if (c.each_phase) {
    file.print("{:.4f},{:.4f},", method.phase.x(), method.phase.y());
  } else {
    file.print(",,");
  }
  file.print("{},{},{:.5f},", method.method, s.balls(), s.found_share());
  if (s.found() == 0) {
    file.print(",,,,,{:.6f},,,,\n", result.bound_px);
    return;
  }
  file.print("{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.4f},", s.bias_px().x(), s.bias_px().y(),
             s.bias_along_px(), s.bias_sigma_px(), s.rmse_px(), result.bound_px,
             s.rmse_px() / result.bound_px);
  if (s.states_covariance()) {
    file.print("{:.4f},{:.2f},{:.4f}\n", s.nees_per_dof(), s.worst_z(), s.coverage());
  } else {
    file.print(",,\n");
  }
}

void WriteTable(const std::vector<ConditionResult>& results, const std::filesystem::path& path) {
  auto file = fmt::output_file(path.string());
  file.print(
      "sweep,diameter_px,snr_db,smear_diameters,hidden_fraction,phase_u,phase_v,method,balls,"
      "found_share,bias_u_px,bias_v_px,bias_along_px,bias_sigma_px,rmse_px,bound_px,ratio,nees_dof,"
      "worst_z,coverage_95\n");
  for (const ConditionResult& result : results) {
    for (const MethodResult& method : result.methods) WriteRow(result, method, file);
  }
}

/// Writes how many centres lie in each class of distance from the truth, 20 classes a decade.
void WriteHistogram(const std::vector<ConditionResult>& results,
                    const std::filesystem::path& path) {
  constexpr int kClassesPerDecade = 20;
  constexpr int kFirst = -4 * kClassesPerDecade;
  constexpr int kLast = 1 * kClassesPerDecade;
  auto file = fmt::output_file(path.string());
  file.print("method,error_from_px,error_to_px,balls\n");
  for (const ConditionResult& result : results) {
    if (!result.condition.keeps_errors) continue;
    for (const MethodResult& method : result.methods) {
      std::vector<int> counts(kLast - kFirst + 1, 0);
      for (const double error_px : method.errors_px) {
        const double place = std::floor(std::log10(error_px) * kClassesPerDecade);
        ++counts[static_cast<std::size_t>(std::clamp<double>(place, kFirst, kLast) - kFirst)];
      }
      for (int i = kFirst; i <= kLast; ++i) {
        file.print("{},{:.6g},{:.6g},{}\n", method.method,
                   std::pow(10, static_cast<double>(i) / kClassesPerDecade),
                   std::pow(10, static_cast<double>(i + 1) / kClassesPerDecade),
                   counts[static_cast<std::size_t>(i - kFirst)]);
      }
    }
  }
}

/// Runs the conditions on `threads` threads; the results do not depend on their number.
std::vector<ConditionResult> RunAll(const std::vector<Condition>& conditions, int threads) {
  std::vector<ConditionResult> results(conditions.size());
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    // The slow ones stand at the end of the list: they come first.
    for (std::size_t i; (i = next++) < conditions.size();) {
      const std::size_t k = conditions.size() - 1 - i;
      results[k] = RunCondition(conditions[k], 1000 + k);
      fmt::print(stderr, "{} of {}\n", i + 1, conditions.size());
    }
  };
  std::vector<std::thread> workers;
  for (int t = 0; t < threads; ++t) workers.emplace_back(work);
  for (std::thread& worker : workers) worker.join();
  return results;
}

/// Keeps the conditions of one sweep (all, where none is named), with at most so many balls.
std::vector<Condition> Chosen(std::vector<Condition> conditions, const std::string& sweep,
                              int most_balls) {
  const auto is_other = [&](const Condition& one) { return !sweep.empty() && one.sweep != sweep; };
  conditions.erase(std::remove_if(conditions.begin(), conditions.end(), is_other),
                   conditions.end());
  for (Condition& condition : conditions) condition.balls = std::min(condition.balls, most_balls);
  return conditions;
}

int Main(int argc, char** argv) {
  CLI::App app("Compares ball centres with the truth and with the Cramér–Rao bound");
  std::filesystem::path output;
  bool quick = false;
  int threads = 2;
  int most_balls = 1000000;
  std::string sweep;
  app.add_option("--output", output, "Folder for accuracy.csv and histogram.csv")->required();
  app.add_flag("--quick", quick, "Few balls and conditions, to see that all works");
  app.add_option("--threads", threads)->check(CLI::Range(1, 64));
  app.add_option("--sweep", sweep, "This one only")
      ->check(CLI::IsMember({"snr", "diameter", "grid", "smear", "hidden", "phase", "histogram"}));
  app.add_option("--balls", most_balls, "At most so many a condition")
      ->check(CLI::Range(1, 1000000));
  CLI11_PARSE(app, argc, argv);
  cv::setNumThreads(1);
  const std::vector<Condition> conditions = Chosen(StudyConditions(quick), sweep, most_balls);
  std::filesystem::create_directories(output);
  const auto results = RunAll(conditions, threads);
  WriteTable(results, output / "accuracy.csv");
  WriteHistogram(results, output / "histogram.csv");
  return 0;
}

}  // namespace
}  // namespace stereomotion::bench

int main(int argc, char** argv) { return stereomotion::bench::Main(argc, argv); }
