#include "record_run.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <exception>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "camera_argument.h"
#include "live_json.h"
#include "live_pair.h"
#include "record_progress.h"
#include "stereomotion/capture/recorder.h"
#include "stereomotion/core/device_error.h"
#include "stereomotion/core/output_error.h"
#include "stereomotion/core/user_error.h"
#include "stereomotion/io/rig_file.h"
#include "stereomotion/io/write_file.h"
#include "stop_signal.h"
#include "version.h"

namespace stereomotion::app {
namespace {

namespace fs = std::filesystem;

// The rig gives names, sources and settings; none is needed.
Rig LoadRig(const std::string& given, fs::path& file) {
  std::error_code ignored;
  file = given.empty() && fs::exists("rig.yaml", ignored) ? fs::path("rig.yaml") : fs::path(given);
  return file.empty() ? Rig{} : ReadRig(file);
}

std::string NameOf(const ResolvedCamera& camera, const Rig& rig, const char* otherwise) {
  const bool in_rig = camera.rig_camera >= 0 && !rig.cameras.empty();
  return in_rig ? rig.cameras[static_cast<std::size_t>(camera.rig_camera)].name : otherwise;
}

fs::path JsonBeside(const fs::path& output) {
  std::error_code ignored;
  if (fs::is_directory(output, ignored)) return output / "record.json";
  return output.string() + ".json";
}

void WriteJson(const RecordOptions& options, const CommonOptions& common, const LiveReport& report,
               const RecorderCounts& counts) {
  LiveExtras extras;
  extras.recorded = counts;
  extras.recording = options.output;
  const nlohmann::ordered_json json = {
      {"format", "stereomotion-record/1"},
      {"version", kVersion},
      {"command", common.command_line},
      {"live", nlohmann::ordered_json::parse(LiveJson(report, extras))}};
  constexpr int kIndent = 2;
  // File names and what a camera calls itself need not be UTF-8.
  const auto replace = nlohmann::ordered_json::error_handler_t::replace;
  WriteFileAtomically(JsonBeside(options.output), json.dump(kIndent, ' ', false, replace) + "\n");
}

// On a disk that is full there is no room for it: what filled it is the problem to tell.
void TryWriteJson(const RecordOptions& options, const CommonOptions& common,
                  const LiveReport& report, const RecorderCounts& counts) {
  try {
    WriteJson(options, common, report, counts);
  } catch (const OutputError& error) {
    spdlog::debug(error.what());
  }
}

// Pairs are taken from the stream by nobody else: they only have to go.
void Drain(const LivePairs& pairs) {
  FramePair pair;
  for (std::int64_t i = 0; pairs.Read(i, pair); ++i) {
  }
}

void Watch(LivePairs& pairs, const Recorder& recorder, const std::atomic<bool>& ended,
           RecordProgress& progress) {
  constexpr std::chrono::milliseconds kLook{50};
  const std::atomic<bool>& stop = CatchStopSignals();
  while (!ended) {
    std::this_thread::sleep_for(kLook);
    if (stop) pairs.Stop("interrupted");
    const RecorderCounts counts = recorder.counts();
    if (!counts.problem.empty()) pairs.Stop("output_failed");
    progress.Show(pairs.report(), counts);
  }
}

LiveReport Take(LivePairs& pairs, const Recorder& recorder, RecordProgress& progress) {
  CatchStopSignals();
  pairs.Start();
  std::atomic<bool> ended{false};
  std::exception_ptr error;
  std::thread drain([&] {
    try {
      Drain(pairs);
    } catch (...) {
      error = std::current_exception();
    }
    ended = true;
  });
  Watch(pairs, recorder, ended, progress);
  drain.join();
  if (error) std::rethrow_exception(error);
  progress.Show(pairs.report(), recorder.counts());
  return pairs.report();
}

void PrintSummary(const LiveReport& report, const RecorderCounts& counts) {
  constexpr double kBytesPerMb = 1e6;
  const auto alone = counts.frames[0] + counts.frames[1] - 2 * counts.pairs;
  fmt::print(
      "pairs recorded   {}\nimages alone     {}\npairs dropped    {}\nMB               {:.1f}\n",
      counts.pairs, alone, counts.dropped, static_cast<double>(counts.bytes) / kBytesPerMb);
  for (const LiveCameraReport& camera : report.cameras) {
    fmt::print("{}: {} images, {:.2f}/s, {} incomplete, {} lost\n", camera.uri,
               camera.counts.frames, camera.rate_hz,
               camera.counts.incomplete + camera.counts.wrong_format,
               camera.counts.lost + camera.counts.underruns);
  }
}

// One that is no live camera: an unknown name, or images that are there already.
void RequireLive(const char* option, const std::string& argument, const ResolvedCamera& camera,
                 const fs::path& rig_file) {
  if (!camera.live.empty()) return;
  const std::string found = std::string(option) + " " + argument + ": ";
  std::error_code ignored;
  fs::path file = camera.path;
  std::string name;
  SplitRecordingArgument(argument, file, name);  // of REC.h5:NAME the file
  if (fs::exists(file, ignored)) {
    throw UserError(found + "is recorded already, expected a live camera (aravis:… or v4l2:…); " +
                    "--export makes image folders of a recording file");
  }
  const std::string rig = rig_file.empty() ? "a rig.yaml" : rig_file.string();
  throw UserError(found + "found neither a camera of " + rig +
                  " with a live source nor a folder, "
                  "expected a live camera: aravis:… or v4l2:… (`stereomotion cameras` lists them)");
}

int Conclude(const RecordOptions& options, const CommonOptions& common, const LiveReport& report,
             const RecorderCounts& counts) {
  if (!common.quiet) PrintSummary(report, counts);
  std::error_code none;  // a file is taken away where no image came
  if (fs::exists(options.output, none)) fmt::print("{}\n", options.output);
  if (!counts.problem.empty()) {
    TryWriteJson(options, common, report, counts);
    throw OutputError(
        fmt::format("{}: the recording ended early, {} pairs before that are readable",
                    counts.problem, counts.pairs));
  }
  WriteJson(options, common, report, counts);
  if (!report.problem.empty()) throw DeviceError(report.problem);
  if (counts.dropped > 0) {
    spdlog::warn("{} pairs were dropped: the disk is too slow for these cameras", counts.dropped);
  }
  return counts.pairs > 0 || report.end == "interrupted" ? kDone : kNoAnswer;
}

}  // namespace

int RunLiveRecord(const RecordOptions& options, const CommonOptions& common) {
  fs::path rig_file;
  const Rig rig = LoadRig(options.rig, rig_file);
  const ResolvedCameras cameras = ResolveCameras(options.left, options.right, rig, rig_file);
  for (const auto& note : cameras.notes) spdlog::info(note);
  RequireLive("--left", options.left, cameras.left, rig_file);
  RequireLive("--right", options.right, cameras.right, rig_file);
  const DiskState disk = LookAtDisk(options.output);
  OpenedCameras opened = OpenCameras(cameras, options.live);
  RecorderOptions recording{options.output};
  recording.names = {NameOf(cameras.left, rig, "cam0"), NameOf(cameras.right, rig, "cam1")};
  recording.overwrite = options.force;
  const std::unique_ptr<Recorder> recorder = StartRecorder(recording);
  LiveArguments arguments = options.live;
  arguments.live.count = options.count;
  LiveReport report;
  RecordProgress progress(options.output, disk, common.quiet);
  {
    const auto pairs = MakeLivePair(std::move(opened), cameras, arguments, recorder.get());
    report = Take(*pairs, *recorder, progress);
  }
  recorder->Finish();
  progress.Clear();
  return Conclude(options, common, report, recorder->counts());
}

}  // namespace stereomotion::app
