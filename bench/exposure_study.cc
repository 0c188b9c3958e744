// Measures how the error of a measured translation depends on speed and exposure, and how far
// moving balls are off at several speeds and lights. What is measured and what came out:
// docs/accuracy.md.
#include <fmt/format.h>
#include <fmt/os.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <opencv2/core.hpp>
#include <thread>

#include "bench/exposure_bound.h"
#include "bench/exposure_measure.h"

namespace stereomotion::bench {
namespace {

/// Level at which a still target fills two thirds of the sensor's range.
constexpr double kFullLevel = 0.65;

struct Cell {
  std::string series;
  ExposureCondition condition;
  int repetitions = 100;
  ExposureSamples samples;
  double bound_mm = 0;
};

/// Short exposures: the lamp is the same, so a longer exposure gathers more light.
void AddConstantLight(std::vector<Cell>& cells) {
  for (const double exposure_s : {0.004, 0.008, 0.016}) {
    for (const double speed_mm_s : {10, 20, 40, 60, 80}) {
      cells.push_back({"constant_light",
                       {speed_mm_s, exposure_s, kFullLevel * exposure_s / 0.016},
                       100,
                       {},
                       0});
    }
  }
}

/// Long exposures: light and exposure are traded so that the photons are the same.
void AddEqualPhotons(std::vector<Cell>& cells) {
  for (const double exposure_s : {0.01, 0.02, 0.04, 0.06, 0.08}) {
    for (const double speed_mm_s : {10, 20, 40, 60, 80}) {
      cells.push_back({"equal_photons", {speed_mm_s, exposure_s, kFullLevel}, 200, {}, 0});
    }
    // Beyond the range of speeds, for the knee: up to smears of most of a diameter.
    for (const double smear_px : {1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0}) {
      ExposureCondition condition{1, exposure_s, kFullLevel};
      condition.speed_mm_s = smear_px / SmearPx(condition);
      if (condition.speed_mm_s > 90) cells.push_back({"equal_photons", condition, 200, {}, 0});
    }
  }
}

void AddDeviations(std::vector<Cell>& cells) {
  for (const double level : {0.65, 0.16, 0.04}) {
    for (const double speed_mm_s : {10, 100, 200, 300, 400}) {
      cells.push_back({"deviation", {speed_mm_s, 0.016, level}, 100, {}, 0});
    }
  }
}

std::vector<Cell> Cells(bool quick) {
  std::vector<Cell> cells;
  AddConstantLight(cells);
  AddEqualPhotons(cells);
  AddDeviations(cells);
  if (!quick) return cells;
  std::vector<Cell> few;
  for (const Cell& cell : cells) {
    if (!few.empty() && few.back().series == cell.series) continue;
    few.push_back(cell);
    few.back().repetitions = 50;
  }
  return few;
}

void RunAll(int threads, std::vector<Cell>& cells) {
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t i; (i = next++) < cells.size();) {
      Cell& cell = cells[i];
      cell.samples = MeasureTranslations(cell.condition, cell.repetitions, 5000 + i);
      cell.bound_mm = TranslationBound_mm(cell.condition);
      fmt::print(stderr, "{} of {}\n", i + 1, cells.size());
    }
  };
  std::vector<std::thread> workers;
  for (int t = 0; t < threads; ++t) workers.emplace_back(work);
  for (std::thread& worker : workers) worker.join();
}

void WriteTranslations(const std::vector<Cell>& cells, const std::filesystem::path& path) {
  auto file = fmt::output_file(path.string());
  file.print(
      "series,speed_mm_s,exposure_ms,ball_level,smear_px,repetitions,lost,bias_along_mm,"
      "rmse_along_mm,rmse_3d_mm,bound_along_mm,nees_along\n");
  for (const Cell& cell : cells) {
    double sum = 0, square = 0, square_3d = 0, nees = 0;
    for (const TranslationSample& sample : cell.samples.translations) {
      sum += sample.error_along_mm;
      square += sample.error_along_mm * sample.error_along_mm;
      square_3d += sample.error_mm * sample.error_mm;
      nees += std::pow(sample.error_along_mm / sample.sigma_along_mm, 2);
    }
    const ExposureCondition& c = cell.condition;
    file.print("{},{:.3f},{:.1f},{},{:.4f},{},{},", cell.series, c.speed_mm_s, 1e3 * c.exposure_s,
               c.ball_level, SmearPx(c), cell.repetitions, cell.samples.lost);
    const auto n = static_cast<double>(cell.samples.translations.size());
    if (n > 0) {
      file.print("{:.7f},{:.7f},{:.7f},{:.7f},{:.4f}\n", sum / n, std::sqrt(square / n),
                 std::sqrt(square_3d / n), cell.bound_mm, nees / n);
    } else {
      file.print(",,,{:.7f},\n", cell.bound_mm);
    }
  }
}

/// Writes the five numbers of a box, and the ends of the middle 90 %, for every ball.
void WriteDeviations(const std::vector<Cell>& cells, const std::filesystem::path& path) {
  auto file = fmt::output_file(path.string());
  file.print(
      "speed_mm_s,ball_level,rod,ball,measured,low_mm,q05_mm,q25_mm,median_mm,q75_mm,q95_mm,high_"
      "mm\n");
  for (const Cell& cell : cells) {
    if (cell.series != "deviation") continue;
    for (int k = 0; k < 10; ++k) {
      const BallId id{k / 5, k % 5};
      std::vector<double> sorted_mm;
      for (const BallDeviation& ball : cell.samples.balls) {
        if (ball.id == id) sorted_mm.push_back(ball.deviation_mm);
      }
      std::sort(sorted_mm.begin(), sorted_mm.end());
      file.print("{},{},{},{},{}", cell.condition.speed_mm_s, cell.condition.ball_level, id.rod,
                 id.ball, sorted_mm.size());
      for (const double share : {0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0}) {
        if (sorted_mm.empty()) {
          file.print(",");
          continue;
        }
        const auto last = static_cast<double>(sorted_mm.size() - 1);
        file.print(",{:.6f}", sorted_mm[static_cast<std::size_t>(std::lround(share * last))]);
      }
      file.print("\n");
    }
  }
}

int Main(int argc, char** argv) {
  CLI::App app("Measures translation errors against speed and exposure");
  std::filesystem::path output;
  bool quick = false;
  int threads = 2;
  app.add_option("--output", output, "Folder for exposure.csv and deviation.csv")->required();
  app.add_flag("--quick", quick, "A cell of every series, to see that all works");
  app.add_option("--threads", threads)->check(CLI::Range(1, 64));
  CLI11_PARSE(app, argc, argv);
  cv::setNumThreads(1);
  std::filesystem::create_directories(output);
  std::vector<Cell> cells = Cells(quick);
  RunAll(threads, cells);
  WriteTranslations(cells, output / "exposure.csv");
  WriteDeviations(cells, output / "deviation.csv");
  return 0;
}

}  // namespace
}  // namespace stereomotion::bench

int main(int argc, char** argv) { return stereomotion::bench::Main(argc, argv); }
