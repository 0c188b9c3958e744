#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <filesystem>
#include <memory>
#include <stdexcept>

#include "commands.h"
#include "number_within.h"
#include "progress.h"
#include "stereomotion/core/output_error.h"
#include "stereomotion/core/user_error.h"
#include "stereomotion/io/scenario_file.h"
#include "stereomotion/simulation/write_recording.h"
#include "stop_signal.h"

namespace stereomotion::app {
namespace {

namespace fs = std::filesystem;

struct SimulateOptions {
  std::string scenario;
  std::string output;
  int threads = 0;
  bool force = false;
};

// Frames of a longer recording must not stay behind, and --force must not cost a real recording,
// which nobody can make again: only a simulated one is cleared.
void ClearRecording(const fs::path& folder, const Scenario& scenario) {
  if (!fs::exists(folder / "truth" / "scene.json")) {
    throw UserError(folder.string() +
                    ": is no simulated recording (truth/scene.json is missing); not overwritten");
  }
  for (const int camera : {0, 1}) fs::remove_all(folder / scenario.rig.cameras[camera].name);
  fs::remove_all(folder / "truth");
}

void MakeOutput(const SimulateOptions& options, const Scenario& scenario) {
  std::error_code error;
  const fs::path folder = options.output;
  if (fs::exists(folder, error) && !fs::is_directory(folder, error)) {
    throw UserError(options.output + ": is a file, expected a folder for the recording (--output)");
  }
  if (fs::exists(folder, error) && !fs::is_empty(folder, error) && !options.force) {
    throw UserError(options.output +
                    ": exists and is not empty; give --force to overwrite, or another --output");
  }
  if (fs::exists(folder, error) && !fs::is_empty(folder, error)) ClearRecording(folder, scenario);
  fs::create_directories(folder, error);
  if (error) throw OutputError(options.output + ": cannot be created: " + error.message());
}

// A recording carries the rig and the body that it shows, so that `track` finds them beside it.
void CopyInputs(const fs::path& scenario, const ScenarioFile& file, const fs::path& folder) {
  std::error_code error;
  for (const auto& [from, name] :
       {std::pair{file.rig, "rig.yaml"}, {file.body, "body.yaml"}, {scenario, "scenario.yaml"}}) {
    if (fs::equivalent(from, folder / name, error)) continue;
    fs::copy_file(from, folder / name, fs::copy_options::overwrite_existing, error);
    if (error) throw OutputError((folder / name).string() + ": " + error.message());
  }
}

int RunSimulate(const SimulateOptions& options, const CommonOptions& common) {
  const ScenarioFile file = ReadScenario(options.scenario);
  MakeOutput(options, file.scenario);
  CopyInputs(options.scenario, file, options.output);
  Progress progress(file.scenario.frames, common.quiet);
  WriteRecordingOptions writing;
  writing.threads = options.threads;
  writing.stop = &CatchStopSignals();
  writing.on_progress = [&](std::int64_t, std::int64_t) { progress.Step(); };
  std::int64_t written = 0;
  try {
    written = WriteRecording(file.scenario, options.output, writing);
  } catch (const std::invalid_argument& error) {
    throw UserError(options.scenario + ": " + error.what());
  } catch (const std::runtime_error& error) {
    throw OutputError(error.what());
  }
  spdlog::info("{} frame pairs rendered", written);
  fmt::print("{}\n", options.output);
  return kDone;
}

}  // namespace

Run AddSimulateCommand(CLI::App& app) {
  auto options = std::make_shared<SimulateOptions>();
  CLI::App* simulate = app.add_subcommand("simulate", "Renders a recording with ground truth");
  simulate->add_option("scenario", options->scenario, "What is rendered (scenario.yaml)")
      ->required();
  simulate->add_option("--output", options->output, "Folder for the recording")->required();
  simulate
      ->add_option("--threads", options->threads, "Threads; 0: one a core. Images do not change")
      ->check(WholeNumberWithin(0, kMostThreads))
      ->capture_default_str();
  simulate->add_flag("--force", options->force, "Overwrite an existing output");
  simulate->footer("Example: stereomotion simulate calib/scenario.yaml --output rec");
  return [options](const CommonOptions& common) { return RunSimulate(*options, common); };
}

}  // namespace stereomotion::app
