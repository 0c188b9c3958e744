#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <filesystem>
#include <memory>
#include <set>

#include "commands.h"
#include "number_within.h"
#include "progress.h"
#include "record_run.h"
#include "stereomotion/capture/export_recording.h"
#include "stereomotion/capture/recorder.h"
#include "stereomotion/core/user_error.h"
#include "stop_signal.h"

namespace stereomotion::app {
namespace {

int RunRepair(const RecordOptions& options) {
  const RepairReport report = RepairRecording(options.repair);
  for (const std::string& note : report.notes) spdlog::info(note);
  fmt::print("{}\n", options.repair);
  return report.frames[0] + report.frames[1] > 0 ? kDone : kNoAnswer;
}

int RunExport(const RecordOptions& options, const CommonOptions& common) {
  std::unique_ptr<Progress> progress;
  const auto step = [&](std::int64_t, std::int64_t all) {
    if (!progress) progress = std::make_unique<Progress>(all, common.quiet, "images");
    progress->Step();
  };
  const std::atomic<bool>& stop = CatchStopSignals();
  ExportRecording(options.export_from,
                  {options.output, "." + options.image_extension, options.force}, step, &stop);
  progress.reset();
  if (stop) spdlog::warn("interrupted: the folders hold the images up to here");
  fmt::print("{}\n", options.output);
  return kDone;
}

void Require(const std::string& value, const char* option, const char* what) {
  if (!value.empty()) return;
  throw UserError(fmt::format("record: found no {}, expected {}", option, what));
}

int RunRecord(const RecordOptions& options, const CommonOptions& common) {
  if (!options.repair.empty()) return RunRepair(options);
  Require(options.output, "--output", "where to: REC.h5, or a folder for images");
  if (!options.export_from.empty()) return RunExport(options, common);
  Require(options.left, "--left", "the left camera: aravis:… or v4l2:…");
  Require(options.right, "--right", "the right camera: aravis:… or v4l2:…");
  return RunLiveRecord(options, common);
}

// An option that changes nothing is a misunderstanding.
void RefuseUnused(CLI::App& record, CLI::Option* repair, CLI::Option* from) {
  const std::set<std::string> of_export = {"--output", "--force", "--image-format"};
  for (CLI::Option* option : record.get_options()) {
    if (option == repair || option == from || option == record.get_help_ptr()) continue;
    repair->excludes(option);
    if (of_export.count(option->get_name()) == 0) from->excludes(option);
  }
}

void AddOtherTasks(CLI::App& record, RecordOptions& options) {
  auto* repair = record.add_option("--repair", options.repair,
                                   "Instead of recording: makes a recording readable that a crash "
                                   "left unfinished (`track` does so by itself)");
  repair->check(NotEmpty());
  auto* from = record.add_option("--export", options.export_from,
                                 "Instead of recording: writes a recording file as folders of "
                                 "images into --output");
  from->check(NotEmpty())->excludes(repair);
  record
      .add_option("--image-format", options.image_extension, "Of the exported images; all lossless")
      ->check(CLI::IsMember({"png", "tif", "pgm"}))
      ->capture_default_str()
      ->needs(from);
  RefuseUnused(record, repair, from);
}

}  // namespace

Run AddRecordCommand(CLI::App& app) {
  auto options = std::make_shared<RecordOptions>();
  CLI::App* record = app.add_subcommand("record", "Records two live cameras");
  record->add_option("--left", options->left, "Left camera: aravis:ID, v4l2:/dev/video0 or a name");
  record->add_option("--right", options->right, "Right camera");
  record->add_option("--rig", options->rig,
                     "Names, sources and settings of the cameras; rig.yaml where it is there");
  record->add_option("--output", options->output, "REC.h5 (HDF5), or a folder for images (PGM)")
      ->check(NotEmpty());
  record->add_option("--count", options->count, "Ends after so many pairs")
      ->check(WholeNumberWithin(1, kMostFrames));
  record->add_flag("--force", options->force, "Replace an existing recording");
  AddLiveOptions(*record, options->live);
  AddOtherTasks(*record, *options);
  record->footer(
      "Ends at --duration, --count or Ctrl-C. Whatever happens, all but the last second can be "
      "read.\nExample: stereomotion record --left aravis:Basler-21876 --right aravis:Basler-21877 "
      "--output take1.h5 --duration 60");
  return [options](const CommonOptions& common) { return RunRecord(*options, common); };
}

}  // namespace stereomotion::app
