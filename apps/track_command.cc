#include <fmt/chrono.h>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <memory>
#include <optional>

#include "commands.h"
#include "learn_mask_run.h"
#include "number_within.h"
#include "progress.h"
#include "run_statistics.h"
#include "stereomotion/io/output_error.h"
#include "stereomotion/io/run_report.h"
#include "stereomotion/io/run_trace.h"
#include "stereomotion/io/run_writer.h"
#include "stereomotion/io/write_file.h"
#include "stereomotion/pipeline/measure.h"
#include "stop_signal.h"
#include "track_inputs.h"
#include "track_record.h"

namespace stereomotion::app {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kReasonsToTell = 3;

std::string DefaultRunName() {
  return fmt::format("run-{:%Y%m%d-%H%M%S}", fmt::localtime(std::time(nullptr)));
}

// Measures into `writer`; a full disk ends the run early and is told by the result.
std::optional<OutputError> Measure(const TrackInputs& inputs, const CommonOptions& common,
                                   RunWriter& writer, RunStatistics& statistics, RunTrace& trace,
                                   RunSummary& summary) {
  const std::atomic<bool>& stop = CatchStopSignals();
  const std::int64_t rest = inputs.recording->size() - inputs.options.first;
  const std::int64_t wanted = inputs.options.count;
  Progress progress(wanted < 0 ? rest : std::min(wanted, rest), common.quiet);
  std::optional<OutputError> failure;
  std::int64_t unreadable = 0;
  const MeasurementSink sink = [&](const PairMeasurement& measurement) {
    if (!measurement.detail.empty() && ++unreadable <= kReasonsToTell) {
      progress.Clear();
      spdlog::warn("frame {} is lost: {}{}", measurement.frame, measurement.detail,
                   unreadable == kReasonsToTell ? " (more such frames are only counted)" : "");
    }
    try {
      writer.Write(measurement);
    } catch (const OutputError& error) {
      failure = error;
      return false;
    }
    statistics.Add(measurement);
    trace.Add(measurement);
    progress.Step();
    return true;
  };
  summary = MeasureRecording(*inputs.recording, inputs.setup, inputs.options, sink, &stop);
  return failure;
}

std::string MostFrequentLoss(const RunSummary& summary) {
  std::string worst = "no frame pair was read";
  std::int64_t most = 0;
  for (const auto& [reason, count] : summary.lost_by_reason) {
    if (count <= most) continue;
    most = count;
    worst = fmt::format("{} of {} pairs: {}", count, summary.pairs_read, reason);
  }
  return worst;
}

int Finish(const RunSummary& summary, const RunStatistics& statistics, const fs::path& folder,
           const CommonOptions& common) {
  for (const auto& warning : summary.warnings) spdlog::warn(warning);
  if (summary.interrupted) spdlog::warn("interrupted: the files hold the pairs up to here");
  if (!common.quiet) fmt::print("{}", statistics.Table(summary));
  fmt::print("{}\n", folder.string());
  if (summary.poses > 0 || summary.interrupted) return kDone;
  fmt::print(stderr, "stereomotion: no pose in the whole recording ({}); see {}\n",
             MostFrequentLoss(summary), (folder / "poses.csv").string());
  return kNoAnswer;
}

void WriteReport(const TrackInputs& inputs, const RunRecord& record, const RunTrace& trace,
                 const fs::path& folder) {
  const auto& cameras = inputs.setup.rig.cameras;
  const RunReport report{record, trace, cameras[static_cast<std::size_t>(inputs.setup.left_camera)],
                         cameras[static_cast<std::size_t>(inputs.setup.right_camera)],
                         inputs.masks};
  WriteFileAtomically(folder / "report.html", RunHtml(report));
}

// The report first: `done` says that all files are there.
void Conclude(const TrackInputs& inputs, const RunTrace& trace, const fs::path& folder,
              std::optional<OutputError> failure, RunWriter& writer, RunRecord& record) {
  record.state = record.summary.interrupted ? "interrupted" : "done";
  try {
    if (!failure) WriteReport(inputs, record, trace, folder);
  } catch (const OutputError& error) {
    failure = error;
  }
  if (failure) record.state = "output_failed";
  writer.WriteRecord(record);
  if (failure) throw OutputError(*failure);
}

int RunTrack(const TrackOptions& options, const CommonOptions& common) {
  const TrackInputs inputs = LoadTrackInputs(options);
  if (!options.learn_mask.empty()) return RunLearnMask(options, inputs, common);
  RunRecord record = StartRecord(inputs, options, common);
  const fs::path folder = options.output.empty() ? DefaultRunName() : options.output;
  RunWriter writer(folder, {inputs.setup.body, record.left_camera, record.right_camera},
                   options.force, record);
  std::error_code ignored;
  fs::remove(folder / "report.html", ignored);  // of an overwritten run
  RunStatistics statistics;
  RunTrace trace(inputs.setup.body);
  const auto failure = Measure(inputs, common, writer, statistics, trace, record.summary);
  AddInputs(options, *inputs.recording, record);
  Conclude(inputs, trace, folder, failure, writer, record);
  return Finish(record.summary, statistics, folder, common);
}

// What changes how the images are measured.
void AddMeasuringOptions(CLI::App& track, TrackOptions& options) {
  constexpr std::int64_t kMostBetween = 10000;  // nobody waits longer for a ball to be seen
  constexpr double kShortest_ms = 1e-4, kLongest_ms = 1e5;
  track
      .add_option("--detector", options.detector,
                  "How a ball's centre is measured. ml: fit under the sensor's noise, the most "
                  "accurate; wavelet: edge points and an ellipse, for whole balls (no poses where "
                  "rods cut them or they smear); centroid: the fastest, for whole balls")
      ->check(CLI::IsMember(DetectorNames()))
      ->capture_default_str();
  track
      .add_option("--search-every", options.search_every,
                  "Search every Nth pair whole, the others only where the balls seen before should "
                  "be. Faster; a ball that comes into sight may be found N - 1 pairs late")
      ->check(WholeNumberWithin(1, kMostBetween))
      ->capture_default_str();
  track
      .add_option("--exposure-ms", options.exposure_ms,
                  "How long a frame was exposed, where the recording does not tell: fast curved "
                  "motion is corrected for it")
      ->check(NumberWithin(kShortest_ms, kLongest_ms));
  auto* mask = track.add_option("--mask", options.mask,
                                "Places in the images where nothing is a ball (mask.yaml)");
  mask->check(NotEmpty());
  track
      .add_option("--learn-mask", options.learn_mask,
                  "Instead of measuring: write a mask of what stays bright in this recording, best "
                  "one without the body, else one in which it moves")
      ->check(NotEmpty())
      ->excludes(mask)
      ->excludes(track.get_option("--output"));
}

}  // namespace

Run AddTrackCommand(CLI::App& app) {
  auto options = std::make_shared<TrackOptions>();
  CLI::App* track = app.add_subcommand("track", "Measures a body in recorded image pairs");
  track->add_option("--left", options->left, "Images of the left camera: folder, video or a name")
      ->required();
  track->add_option("--right", options->right, "Images of the right camera")->required();
  track->add_option("--rig", options->rig, "The calibrated cameras")->capture_default_str();
  track->add_option("--body", options->body, "The body and its rods (body.yaml)");
  track->add_option("--output", options->output,
                    "Folder for the results; run-DATE-TIME by default");
  track->add_option("--fps", options->fps, "Frames a second, where the recording has no times")
      ->check(NumberWithin(kLowestFps, kHighestFps));
  track->add_option("--start", options->start, "First pair, from 0")
      ->check(WholeNumberWithin(0, kMostFrames));
  track->add_option("--count", options->count, "How many pairs")
      ->check(WholeNumberWithin(1, kMostFrames));
  track->add_option("--threads", options->threads, "Threads; 0: one a core. Results do not change")
      ->check(WholeNumberWithin(0, kMostThreads))
      ->capture_default_str();
  AddMeasuringOptions(*track, *options);
  track->add_flag("--force", options->force, "Overwrite an existing output");
  track->footer(
      "Examples:\n"
      "  stereomotion track --left rec/cam0 --right rec/cam1 --rig rec/rig.yaml --body body.yaml\n"
      "  stereomotion track --left cam0 --right cam1 --body body.yaml --detector centroid\n"
      "  stereomotion track --left cam0 --right cam1 --body body.yaml --search-every 10\n"
      "  stereomotion track --left empty/cam0 --right empty/cam1 --body body.yaml --learn-mask "
      "mask.yaml\n"
      "  stereomotion track --left cam0 --right cam1 --body body.yaml --mask mask.yaml");
  return [options](const CommonOptions& common) { return RunTrack(*options, common); };
}

}  // namespace stereomotion::app
