#include <fmt/chrono.h>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <set>

#include "calibrate_inputs.h"
#include "calibrate_summary.h"
#include "commands.h"
#include "number_within.h"
#include "refine_run.h"
#include "stereomotion/calibration/calibrate.h"
#include "stereomotion/capture/sha256.h"
#include "stereomotion/core/median.h"
#include "stereomotion/core/output_error.h"
#include "stereomotion/core/user_error.h"
#include "stereomotion/io/calibration_json.h"
#include "stereomotion/io/calibration_report.h"
#include "stereomotion/io/rig_writer.h"
#include "stereomotion/io/write_file.h"
#include "version.h"

namespace stereomotion::app {
namespace {

namespace fs = std::filesystem;

struct CalibrateCommand {
  std::string frame;
  std::string output;  // rig.yaml, of --refine rig_refined.yaml
  std::string report = "calibration.html";
  int threads = 0;
  RefineOptionsOfRun refine;
};

// Reproducible builds' convention: the same input gives the same bytes on any day.
std::string Date() {
  std::time_t now = std::time(nullptr);
  if (const char* epoch = std::getenv("SOURCE_DATE_EPOCH")) {
    char* end = nullptr;
    const long long given = std::strtoll(epoch, &end, 10);
    if (end == epoch || *end != '\0' || given < 0) {
      throw UserError(
          fmt::format("SOURCE_DATE_EPOCH: found '{}', expected seconds since 1970", epoch));
    }
    now = static_cast<std::time_t>(given);
  }
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(now));
}

CalibrationRecord MakeRecord(const Calibration& calibration, const CalibrateInputs& inputs,
                             const std::string& frame, const std::string& date) {
  CalibrationRecord record;
  record.date = date;
  record.program = std::string("stereomotion ") + kVersion;
  record.source = frame;
  record.target = TargetTypeName(inputs.file.setup.target.type);
  record.views = inputs.file.num_views;
  record.rms_px = calibration.rms_px;
  record.chi2_dof = calibration.chi2_dof;
  if (!calibration.check_points.empty()) record.check_points_rms_mm = CheckPointsRmsMm(calibration);
  if (calibration.cross_validation) {
    record.cross_validation_rms_mm = calibration.cross_validation->rms_mm;
  }
  return record;
}

// Median width of the edges in each image, [camera][view].
std::vector<std::vector<double>> MedianBlur(const CalibrateInputs& inputs) {
  std::vector<std::vector<std::vector<double>>> all(inputs.file.cameras.size());
  for (auto& camera : all) camera.resize(inputs.file.num_views);
  for (const TargetObservation& o : inputs.observations) {
    if (o.view < inputs.file.num_views) all[o.camera][o.view].push_back(o.blur_px);
  }
  std::vector<std::vector<double>> medians;
  for (const auto& camera : all) {
    auto& views = medians.emplace_back();
    for (const auto& blurs : camera) views.push_back(Median(blurs));
  }
  return medians;
}

CalibrationInputs DescribeInputs(const CalibrateInputs& inputs, const CommonOptions& common,
                                 const std::string& date) {
  CalibrationInputs described;
  described.version = kVersion;
  described.command = common.command_line;
  described.date = date;
  for (const fs::path& file : inputs.file.inputs) {
    described.files.push_back({"input", file.string(), Sha256OfFile(file)});
  }
  for (const FrameCamera& camera : inputs.file.cameras) {
    std::vector<std::string>& names = described.images.emplace_back();
    for (const fs::path& image : camera.images) names.push_back(image.string());
    names.resize(inputs.file.num_views);
  }
  described.blur_px = MedianBlur(inputs);
  return described;
}

// A rig that somebody may still need is set aside, not lost.
void AddFormerRig(const fs::path& file, std::vector<TextFile>& files) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return;
  std::ifstream stream(file, std::ios::binary);
  files.push_back(
      {file.string() + ".old", std::string(std::istreambuf_iterator<char>(stream), {})});
  spdlog::info("the former {} goes to {}.old", file.string(), file.string());
}

// Where the numbers of the report go.
fs::path JsonBeside(const std::string& report) {
  return fs::path(report).replace_extension(".json");
}

void Write(const CalibrateCommand& command, const Calibration& calibration,
           const CalibrateInputs& inputs, const CommonOptions& common) {
  const std::string date = Date();
  const CalibrationInputs described = DescribeInputs(inputs, common, date);
  std::vector<TextFile> files;
  AddFormerRig(command.output, files);
  files.push_back({command.output,
                   RigYaml(calibration.rig, MakeRecord(calibration, inputs, command.frame, date))});
  files.push_back({command.report, CalibrationHtml(calibration, inputs.file.setup, described)});
  files.push_back(
      {JsonBeside(command.report), CalibrationJson(calibration, inputs.file.setup, described)});
  WriteFilesAtomically(files);
}

void CheckOutputs(const CalibrateCommand& command) {
  for (const auto& [option, path] :
       {std::pair{"--output", command.output}, {"--report", command.report}}) {
    const fs::path folder = fs::absolute(path).parent_path();
    if (fs::is_directory(path)) {
      throw UserError(fmt::format("{}: found the folder {}, expected a file", option, path));
    }
    if (!fs::is_directory(folder)) {
      throw UserError(fmt::format("{}: the folder {} does not exist", option, folder.string()));
    }
  }
  std::set<fs::path> files;
  for (const fs::path& file : {fs::path(command.frame), fs::path(command.output),
                               fs::path(command.report), JsonBeside(command.report)}) {
    if (files.insert(fs::weakly_canonical(fs::absolute(file))).second) continue;
    throw UserError(fmt::format(
        "calibrate: {} would be written over another of its files; expected different names for "
        "frame.yaml, --output, --report and the report's numbers ({})",
        file.string(), JsonBeside(command.report).string()));
  }
}

// A slip of the finger must not turn the seeds into a rig.
void CheckInputsStay(const CalibrateCommand& command, const FrameFile& file) {
  for (const fs::path& output :
       {fs::path(command.output), fs::path(command.report), JsonBeside(command.report)}) {
    for (const fs::path& input : file.inputs) {
      std::error_code error;
      if (!fs::equivalent(output, input, error)) continue;
      throw UserError(fmt::format("calibrate: {} is read from, expected another name to write to",
                                  output.string()));
    }
  }
}

int Fail(const CalibrateCommand& command, const CalibrationNote& reason) {
  fmt::print(stderr, "stereomotion: {}: no calibration: {}: {}\n", command.frame, reason.name,
             reason.text);
  return kNoAnswer;
}

int RunRefine(const CalibrateCommand& command, const CommonOptions& common) {
  if (!command.frame.empty()) {
    throw UserError(
        fmt::format("calibrate: found both {} and --refine, expected one of them", command.frame));
  }
  RefineOptionsOfRun refine = command.refine;
  refine.output = command.output.empty() ? "rig_refined.yaml" : command.output;
  refine.date = Date();
  return RefineRun(refine, common);
}

int RunCalibrate(CalibrateCommand command, const CommonOptions& common) {
  if (!command.refine.run.empty()) return RunRefine(command, common);
  if (command.frame.empty()) {
    throw UserError(
        "calibrate: expected a frame.yaml, or --refine RUN (calib/frame_*.yaml are "
        "commented examples)");
  }
  if (command.output.empty()) command.output = "rig.yaml";
  CheckOutputs(command);
  const CalibrateInputs inputs = LoadCalibrateInputs(command.frame, command.threads, common);
  if (inputs.interrupted) {
    fmt::print(stderr, "stereomotion: interrupted; nothing was written\n");
    return kNoAnswer;
  }
  CheckInputsStay(command, inputs.file);
  if (inputs.blind_camera) return Fail(command, *inputs.blind_camera);
  for (const auto& note : inputs.notes) spdlog::warn("{}: {}", note.name, note.text);
  CalibrateOptions options;
  options.image_sigma_known = inputs.image_sigma_known;
  options.progress = [](const std::string& what) { spdlog::info("{}", what); };
  auto calibration = Calibrate(inputs.file.setup, inputs.observations, options);
  if (!calibration) return Fail(command, calibration.error());
  for (const auto& note : calibration->warnings) spdlog::warn("{}: {}", note.name, note.text);
  calibration->warnings.insert(calibration->warnings.begin(), inputs.notes.begin(),
                               inputs.notes.end());
  Write(command, *calibration, inputs, common);
  if (!common.quiet) fmt::print("{}", CalibrationSummary(*calibration));
  fmt::print("{}\n{}\n", command.output, command.report);
  return kDone;
}

void AddRefineOptions(CLI::App& calibrate, RefineOptionsOfRun& refine) {
  calibrate.add_option(
      "--refine", refine.run,
      "Instead of a frame.yaml: re-level the rig of this finished run by the rods");
  calibrate.add_option("--rig", refine.rig, "With --refine: this rig instead of the run's");
  calibrate.add_option("--body", refine.body, "With --refine: this body instead of the run's");
  calibrate.add_flag("--force", refine.force, "With --refine: overwrite an existing output");
}

}  // namespace

Run AddCalibrateCommand(CLI::App& app) {
  auto command = std::make_shared<CalibrateCommand>();
  CLI::App* calibrate =
      app.add_subcommand("calibrate", "Calibrates cameras from images of a target");
  calibrate->add_option("frame", command->frame, "What the images show (frame.yaml)");
  calibrate->add_option("--output", command->output,
                        "The calibrated rig; rig.yaml by default, of --refine rig_refined.yaml");
  calibrate
      ->add_option("--report", command->report,
                   "The report, a web page; its numbers go to the same name with .json")
      ->capture_default_str();
  calibrate
      ->add_option("--threads", command->threads, "Threads; 0: one a core. Results do not change")
      ->check(WholeNumberWithin(0, kMostThreads))
      ->capture_default_str();
  AddRefineOptions(*calibrate, command->refine);
  calibrate->footer(
      "Examples: stereomotion calibrate frame.yaml --output rig.yaml\n"
      "          stereomotion calibrate --refine run-20261122-101500 --output rig_refined.yaml");
  return [command](const CommonOptions& common) { return RunCalibrate(*command, common); };
}

}  // namespace stereomotion::app
