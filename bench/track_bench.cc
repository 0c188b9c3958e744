// How many frame pairs a second `track` measures when the images are in memory already, and where
// the time goes: two cameras of 1280×1024, a body of ten balls, two threads, all files written.
// The processor time a pair is the figure to trust where other work runs beside it.
//
//   track_bench [PAIRS]      # pairs a run; 1000 by default

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <utility>
#include <vector>

#include "stereomotion/io/run_trace.h"
#include "stereomotion/io/run_writer.h"
#include "stereomotion/pipeline/measure.h"
#include "tests/support/simulated_pairs.h"
#include "tests/support/synthetic_scene.h"

namespace stereomotion {
namespace {

constexpr int kRendered = 30;  // pairs held in memory: 79 MB
constexpr int kRuns = 5;       // of each setting, interleaved
constexpr int kThreads = 2;

/// Goes to and fro through rendered pairs, so that the motion never jumps.
class ToAndFro : public PairSource {
 public:
  ToAndFro(const Scenario& scenario, std::int64_t size) : size_(size), pairs_(kRendered) {
    for (int i = 0; i < kRendered; ++i) testing::RenderPair(scenario, i, pairs_[i]);
    for (FramePair& pair : pairs_) {
      pair.left.exposure_us = pair.right.exposure_us = 1e6 * scenario.sensor.exposure_s;
    }
  }
  [[nodiscard]] std::int64_t size() const override { return size_; }
  bool Read(std::int64_t position, FramePair& pair) const override {
    constexpr std::int64_t kPeriod = 2 * kRendered - 2;
    const std::int64_t phase = position % kPeriod;
    pair = pairs_[static_cast<std::size_t>(std::min(phase, kPeriod - phase))];
    pair.left.index = pair.right.index = position;
    pair.left.timestamp_ns = pair.right.timestamp_ns = 1'000'000'000 + position * 5'000'000;
    return true;
  }

 private:
  std::int64_t size_;
  std::vector<FramePair> pairs_;
};

Scenario MakeScenario() {
  Scenario scenario;
  scenario.rig = testing::MakeConvergingRig();
  scenario.body = testing::MakeTwoRodBody();
  scenario.motion.spin_in_world_rad_s = {0.5, 1.5, 2};
  scenario.sensor.exposure_s = 0.001;
  scenario.fps = 200;
  scenario.frames = kRendered;
  return scenario;
}

struct Setting {
  const char* name;
  DetectorMethod method;
  int search_every;
};

struct TimedRun {
  RunSummary summary;
  double cpu_ms = 0;  ///< of the whole process
};

TimedRun Measure(const PairSource& source, const MeasureSetup& setup, const Setting& setting) {
  const auto folder = std::filesystem::temp_directory_path() / "stereomotion_track_bench";
  RunWriter writer(folder, {setup.bodies, "cam0", "cam1"}, true, {});
  RunTrace trace(setup.bodies.front());
  MeasureOptions options;
  options.threads = kThreads;
  options.detection.method = setting.method;
  options.search_every = setting.search_every;
  const std::clock_t start = std::clock();
  RunSummary summary =
      MeasureRecording(source, setup, options, [&](const PairMeasurement& measurement) {
        writer.Write(measurement);
        trace.Add(measurement);
        return true;
      });
  const double cpu_ms = 1000.0 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  std::filesystem::remove_all(folder);
  return {std::move(summary), cpu_ms};
}

double PairsPerSecond(const RunSummary& summary) {
  const double learning_ms = summary.stage_ms.at("learn_noise");  // once a run, not a pair
  return 1000 * static_cast<double>(summary.pairs_read) / (summary.elapsed_ms - learning_ms);
}

void Print(const Setting& setting, std::vector<TimedRun>& runs) {
  std::sort(runs.begin(), runs.end(), [](const TimedRun& a, const TimedRun& b) {
    return PairsPerSecond(a.summary) < PairsPerSecond(b.summary);
  });
  const TimedRun& middle = runs[runs.size() / 2];
  const RunSummary& median = middle.summary;
  const auto pairs = static_cast<double>(median.pairs_read);
  const auto ms_a_pair = [&](const char* stage) { return median.stage_ms.at(stage) / pairs; };
  // Learning the noise is counted in: once a run, all images read once more.
  const double cpu_ms = middle.cpu_ms / pairs;
  fmt::print(
      "{:26} {:8.0f} {:8.0f} | {:6.3f} {:8.0f} | {:6.3f} {:7.3f} {:6.3f} {:6.3f} | {:.1f} %\n",
      setting.name, PairsPerSecond(median), PairsPerSecond(runs.back().summary), cpu_ms,
      1000 * kThreads / cpu_ms, ms_a_pair("read"), ms_a_pair("detect"), ms_a_pair("pose"),
      ms_a_pair("write"), 100.0 * static_cast<double>(median.poses) / pairs);
}

int Run(std::int64_t pairs) {
  const std::vector<Setting> settings = {
      {"ml", DetectorMethod::kMaximumLikelihood, 1},
      {"ml, --search-every 10", DetectorMethod::kMaximumLikelihood, 10},
      {"centroid", DetectorMethod::kCentroid, 1},
      {"centroid, --search-every 10", DetectorMethod::kCentroid, 10}};
  const Scenario scenario = MakeScenario();
  const ToAndFro source(scenario, pairs);
  const MeasureSetup setup{scenario.rig, 0, 1, {scenario.body}, {}, {}};
  std::vector<std::vector<TimedRun>> runs(settings.size());
  for (int run = 0; run < kRuns; ++run) {
    for (std::size_t i = 0; i < settings.size(); ++i) {
      runs[i].push_back(Measure(source, setup, settings[i]));
    }
  }
  fmt::print("{} pairs, {} threads, median of {} runs\n", pairs, kThreads, kRuns);
  fmt::print("{:26} {:>8} {:>8} | {:>6} {:>8} | {:>6} {:>7} {:>6} {:>6} | poses\n", "", "pairs/s",
             "best", "cpu ms", "pairs/s*", "read", "detect", "pose", "write");
  for (std::size_t i = 0; i < settings.size(); ++i) Print(settings[i], runs[i]);
  return 0;
}

}  // namespace
}  // namespace stereomotion

int main(int argc, char** argv) {
  const std::int64_t pairs = argc > 1 ? std::atoll(argv[1]) : 1000;
  return stereomotion::Run(std::max<std::int64_t>(pairs, 1));
}
