#include <fmt/chrono.h>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <memory>
#include <optional>
#include <thread>

#include "commands.h"
#include "number_within.h"
#include "progress.h"
#include "run_statistics.h"
#include "stereomotion/capture/recording.h"
#include "stereomotion/capture/sha256.h"
#include "stereomotion/io/output_error.h"
#include "stereomotion/io/run_writer.h"
#include "stereomotion/pipeline/measure.h"
#include "stop_signal.h"
#include "track_inputs.h"
#include "version.h"

namespace stereomotion::app {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kReasonsToTell = 3;

std::string UtcNow() {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
}

RunRecord StartRecord(const TrackInputs& inputs, const CommonOptions& common) {
  const RecordingReport& report = inputs.recording->report();
  const auto& cameras = inputs.setup.rig.cameras;
  RunRecord record;
  record.version = kVersion;
  record.command = common.command_line;
  record.started = UtcNow();
  record.left_camera = cameras[static_cast<std::size_t>(inputs.setup.left_camera)].name;
  record.right_camera = cameras[static_cast<std::size_t>(inputs.setup.right_camera)].name;
  record.left_frames = report.left_frames;
  record.right_frames = report.right_frames;
  record.unpaired_left = report.unpaired_left;
  record.unpaired_right = report.unpaired_right;
  record.paired_by_time = report.paired_by_time;
  record.warnings = report.warnings;
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  record.threads = inputs.options.threads > 0 ? inputs.options.threads : cores;
  return record;
}

void AddInputs(const TrackOptions& options, const Recording& recording, RunRecord& record) {
  record.inputs = {{"rig", options.rig, Sha256OfFile(options.rig)},
                   {"body", options.body, Sha256OfFile(options.body)}};
  for (const auto& [side, role, path] :
       {std::tuple{Side::kLeft, "left", options.left}, {Side::kRight, "right", options.right}}) {
    const std::string images = recording.InputDigest(side);
    if (!images.empty()) record.inputs.push_back({role, path, images});
    for (const fs::path& file : recording.InputFiles(side)) {
      record.inputs.push_back({role, file.string(), Sha256OfFile(file)});
    }
  }
}

std::string DefaultRunName() {
  return fmt::format("run-{:%Y%m%d-%H%M%S}", fmt::localtime(std::time(nullptr)));
}

// Measures into `writer`; a full disk ends the run early and is told by the result.
std::optional<OutputError> Measure(const TrackInputs& inputs, const CommonOptions& common,
                                   RunWriter& writer, RunStatistics& statistics,
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

int RunTrack(const TrackOptions& options, const CommonOptions& common) {
  const TrackInputs inputs = LoadTrackInputs(options);
  RunRecord record = StartRecord(inputs, common);
  const fs::path folder = options.output.empty() ? DefaultRunName() : options.output;
  RunWriter writer(folder, {inputs.setup.body, record.left_camera, record.right_camera},
                   options.force, record);
  RunStatistics statistics;
  const auto failure = Measure(inputs, common, writer, statistics, record.summary);
  record.state = failure ? "output_failed" : record.summary.interrupted ? "interrupted" : "done";
  AddInputs(options, *inputs.recording, record);
  writer.WriteRecord(record);
  if (failure) throw OutputError(*failure);
  return Finish(record.summary, statistics, folder, common);
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
  track->add_flag("--force", options->force, "Overwrite an existing output");
  track->footer(
      "Example: stereomotion track --left rec/cam0 --right rec/cam1 --rig rec/rig.yaml "
      "--body body.yaml --output result");
  return [options](const CommonOptions& common) { return RunTrack(*options, common); };
}

}  // namespace stereomotion::app
