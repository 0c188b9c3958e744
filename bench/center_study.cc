// Compares centres and axes of rotation with those of published methods, after Ehrig et al. (2006,
// J. Biomech. 39:2798; 2007, 40:2150): four markers a segment, Gaussian noise, ranges of motion
// from 5° to 90°. Writes DIR/centers.csv, which scripts/accuracy.sh makes tables and a plot of. The
// set-up: bench/marker_scene.cc, docs/accuracy.md.
#include <fmt/format.h>
#include <fmt/os.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <thread>

#include "bench/center_trial.h"
#include "bench/paired_score.h"

namespace stereomotion::bench {
namespace {

struct Cell {
  std::string name;
  double range_deg = 0;
  MarkerScene scene;
  std::uint64_t seed = 0;  ///< the trials' seeds count up from it
};

struct Quantity {
  std::string name;
  std::vector<MethodErrors> methods;
};

std::vector<Cell> Cells(const std::vector<double>& ranges_deg) {
  constexpr double kRadPerDegree = 0.017453292519943295;
  const double per_marker_mm = 1 / std::sqrt(3.0);  // σ = 1 mm of the distance, not a coordinate
  std::vector<Cell> cells;
  const auto add = [&](const char* name, JointKind kind, double sigma_mm) {
    for (const double range_deg : ranges_deg) {
      cells.push_back({name, range_deg, {kind, kRadPerDegree * range_deg}});
      cells.back().scene.sigma_mm = sigma_mm;
    }
  };
  add("ball", JointKind::kBall, 1);
  add("ball_per_marker", JointKind::kBall, per_marker_mm);
  add("ball_both_moving", JointKind::kBallBothMoving, 1);
  add("ball_both_mirrored", JointKind::kBallBothMoving, 1);
  const double like_moving_mm = -MovingCluster_mm().row(2).mean();
  for (Cell& cell : cells) {
    if (cell.name == "ball_both_mirrored") cell.scene.base_distance_mm = like_moving_mm;
  }
  add("hinge", JointKind::kHinge, 1);
  constexpr std::uint64_t kTrialsApart = 1'000'000;
  for (std::size_t i = 0; i < cells.size(); ++i) cells[i].seed = kTrialsApart * (i + 1);
  return cells;
}

Quantity& QuantityNamed(const std::string& name, std::vector<Quantity>& quantities) {
  for (Quantity& quantity : quantities) {
    if (quantity.name == name) return quantity;
  }
  return quantities.emplace_back(Quantity{name, {}});
}

MethodErrors& ErrorsOf(const TrialError& error, std::vector<MethodErrors>& methods) {
  for (MethodErrors& method : methods) {
    if (method.method == error.method) return method;
  }
  return methods.emplace_back(
      MethodErrors{error.method, error.is_baseline, {}, {}, error.nees_dof});
}

/// Puts a trial's errors to those of the trials before it.
void Gather(const std::vector<TrialError>& trial, std::vector<Quantity>& quantities) {
  for (const TrialError& error : trial) {
    MethodErrors& method = ErrorsOf(error, QuantityNamed(error.quantity, quantities).methods);
    method.errors.push_back(error.error);
    if (error.nees) method.nees.push_back(*error.nees);
  }
}

/// Every trial has a seed of its own, so neither threads nor the number of trials change it.
std::vector<Quantity> RunCell(const Cell& cell, int trials) {
  std::vector<Quantity> quantities;
  for (int k = 0; k < trials; ++k) {
    std::mt19937_64 rng(cell.seed + static_cast<std::uint64_t>(k));
    Gather(RunTrial(cell.scene, rng), quantities);
  }
  return quantities;
}

std::vector<std::vector<Quantity>> RunAll(const std::vector<Cell>& cells, int trials, int threads) {
  std::vector<std::vector<Quantity>> results(cells.size());
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t i; (i = next++) < cells.size();) {
      results[i] = RunCell(cells[i], trials);
      fmt::print(stderr, "{} of {}\n", i + 1, cells.size());
    }
  };
  std::vector<std::thread> workers;
  for (int t = 0; t < threads; ++t) workers.emplace_back(work);
  for (std::thread& worker : workers) worker.join();
  return results;
}

std::string NeesPerDof(const MethodErrors& method) {
  if (method.nees.empty()) return "";
  double sum = 0;
  for (const double nees : method.nees) sum += nees;
  return fmt::format("{:.3f}", sum / static_cast<double>(method.nees.size()) / method.nees_dof);
}

/// Empty where it is not a number: a method without an answer in some trial has no RMSE.
std::string Number(double value) {
  return std::isfinite(value) ? fmt::format("{:.5g}", value) : std::string();
}

/// One line of centers.csv; the ratio is to the best baseline, of baselines themselves too.
std::string Row(const Cell& cell, const Quantity& quantity, const MethodErrors& method) {
  const PairedRatio to_best = CompareRmse(method.errors, BestBaseline(quantity.methods).errors);
  const auto answered = std::count_if(method.errors.begin(), method.errors.end(),
                                      [](double error) { return std::isfinite(error); });
  std::string row = fmt::format("{},{},{:.4f},{},{},{},\"{}\",{},{}", cell.name, cell.range_deg,
                                cell.scene.sigma_mm, cell.scene.frames, method.errors.size(),
                                quantity.name, method.method, method.is_baseline ? 1 : 0, answered);
  for (const double value :
       {Rmse(method.errors), Quantile(method.errors, 0.5), Quantile(method.errors, 0.95),
        Quantile(method.errors, 1), to_best.ratio, to_best.lower, to_best.upper}) {
    row += "," + Number(value);
  }
  return row + "," + NeesPerDof(method) + "\n";
}

std::string Csv(const std::vector<Cell>& cells, const std::vector<std::vector<Quantity>>& results) {
  std::string text =
      "scene,range_deg,sigma_mm,frames,trials,quantity,method,baseline,answered,rmse,median,q95,"
      "largest,ratio,ratio_lower,ratio_upper,nees_dof\n";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    for (const Quantity& quantity : results[i]) {
      for (const MethodErrors& method : quantity.methods) text += Row(cells[i], quantity, method);
    }
  }
  return text;
}

int Main(int argc, char** argv) {
  CLI::App app("Compares centres and axes of rotation with those of published methods");
  std::filesystem::path output;
  bool quick = false;
  int threads = 2, trials = 1000;
  std::string scene;
  app.add_option("--output", output, "Folder for centers.csv")->required();
  app.add_flag("--quick", quick, "Two ranges and few trials, to see that all works");
  app.add_option("--threads", threads)->check(CLI::Range(1, 64));
  app.add_option("--trials", trials, "A range")->check(CLI::Range(2, 1'000'000));
  app.add_option("--scene", scene, "This one only")
      ->check(CLI::IsMember(
          {"ball", "ball_per_marker", "ball_both_moving", "ball_both_mirrored", "hinge"}));
  CLI11_PARSE(app, argc, argv);
  constexpr int kQuickTrials = 12;
  std::vector<Cell> cells = quick ? Cells({20, 90}) : Cells({5, 10, 20, 30, 45, 60, 90});
  const auto is_other = [&](const Cell& cell) { return !scene.empty() && cell.name != scene; };
  cells.erase(std::remove_if(cells.begin(), cells.end(), is_other), cells.end());
  const auto results = RunAll(cells, quick ? std::min(trials, kQuickTrials) : trials, threads);
  std::filesystem::create_directories(output);
  fmt::output_file((output / "centers.csv").string()).print("{}", Csv(cells, results));
  return 0;
}

}  // namespace
}  // namespace stereomotion::bench

int main(int argc, char** argv) { return stereomotion::bench::Main(argc, argv); }
