#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <memory>

#include "analyse_inputs.h"
#include "analyse_options.h"
#include "analyse_results.h"
#include "commands.h"
#include "motion_run.h"
#include "stereomotion/core/output_error.h"
#include "stereomotion/core/user_error.h"
#include "stereomotion/io/run_analysis.h"
#include "stereomotion/io/write_file.h"

namespace stereomotion::app {
namespace {

namespace fs = std::filesystem;

// An analysis of a RUN replaces its own files there; anywhere else nothing is overwritten unasked.
void CheckFolders(const AnalyseArguments& arguments, const AnalyseInputs& inputs) {
  const bool own = inputs.is_run && arguments.output.empty();
  for (const AnalyseBody& body : inputs.bodies) {
    std::error_code error;
    if (fs::exists(body.folder, error) && !fs::is_directory(body.folder, error)) {
      throw UserError(body.folder.string() + ": is a file, expected a folder (--output)");
    }
    if (!own && fs::exists(body.folder / "motion.json", error) && !arguments.force) {
      throw UserError(body.folder.string() +
                      ": holds an analysis already; give --force to replace it, or another "
                      "--output");
    }
  }
}

// All files or none; only then go the results of an earlier analysis that this one did not make.
void WriteResults(const AnalyseArguments& arguments, const AnalyseInputs& inputs,
                  const std::vector<TextFile>& files) {
  const std::vector<fs::path> stale = StaleResults(arguments, inputs, files);
  std::error_code error;
  for (const AnalyseBody& body : inputs.bodies) {
    fs::create_directories(body.folder, error);
    if (error) throw OutputError(body.folder.string() + ": " + error.message());
  }
  WriteFilesAtomically(files);
  for (const fs::path& file : stale) {
    if (!fs::remove(file, error) && error) {
      throw OutputError(file.string() + ": cannot be removed: " + error.message());
    }
  }
}

bool HasAnswer(const std::vector<BodyMotion>& bodies) {
  for (const BodyMotion& body : bodies) {
    if (!body.analysis.spin.laws.empty()) return true;
  }
  return false;
}

// Holds all that an analysis gives, before anything is written.
struct Results {
  std::vector<BodyMotion> bodies;
  std::vector<TextFile> files;
  std::string filter;  ///< with all its numbers; empty: none
  std::string joints;  ///< for a person
};

// All that can refuse an option happens here.
Results Analyse(const AnalyseArguments& arguments, const AnalyseInputs& inputs,
                const AnalyseOptions& options) {
  Results results;
  for (const AnalyseBody& body : inputs.bodies) {
    results.bodies.push_back({body.name, AnalyseMotion(body.data, options)});
    const MotionAnalysis& analysis = results.bodies.back().analysis;
    for (TextFile& file : MotionTexts(body.folder, analysis)) {
      results.files.push_back(std::move(file));
    }
    if (!arguments.filter.empty()) {
      results.filter = AddFiltered(arguments, body.folder, analysis, results.files);
    }
  }
  AddRelative(arguments, inputs, results.bodies, results.files);
  AddJointAngles(arguments, inputs.folder, results.bodies, results.files);
  JointTexts joints = FindJoints(inputs.folder, results.bodies);
  results.joints = std::move(joints.summary);
  for (TextFile& file : joints.files) results.files.push_back(std::move(file));
  return results;
}

void Tell(const Results& results, bool quiet) {
  for (const BodyMotion& body : results.bodies) {
    if (!quiet && results.bodies.size() > 1) fmt::print("{}\n", body.name);
    if (!quiet) fmt::print("{}", MotionSummary(body.analysis));
    for (const std::string& warning : body.analysis.warnings) spdlog::warn(warning);
  }
  if (!quiet) fmt::print("{}", results.joints);
  if (!quiet && !results.filter.empty()) fmt::print("  {:<26}{}\n", "filter", results.filter);
}

int RunAnalyse(const AnalyseArguments& arguments, const CommonOptions& common) {
  const AnalyseOptions options = MakeAnalyseOptions(arguments);
  const AnalyseInputs inputs = LoadAnalyseInputs(arguments, options);
  for (const std::string& warning : inputs.warnings) spdlog::warn(warning);
  if (!inputs.no_answer.empty()) {
    fmt::print(stderr, "stereomotion: {}\n", inputs.no_answer);
    return kNoAnswer;
  }
  CheckFolders(arguments, inputs);
  const Results results = Analyse(arguments, inputs, options);
  WriteResults(arguments, inputs, results.files);
  if (inputs.is_run && arguments.output.empty()) {
    NoteAnalysis(inputs.folder, common.command_line, results.filter);
  }
  Tell(results, common.quiet);
  fmt::print("{}\n", inputs.folder.string());
  return HasAnswer(results.bodies) ? kDone : kNoAnswer;
}

}  // namespace

Run AddAnalyseCommand(CLI::App& app) {
  auto arguments = std::make_shared<AnalyseArguments>();
  CLI::App* analyse = app.add_subcommand(
      "analyse", "Motion, spin centre, axes and filters from a RUN, poses or markers");
  AddAnalyseOptions(*analyse, *arguments);
  return [arguments](const CommonOptions& common) { return RunAnalyse(*arguments, common); };
}

}  // namespace stereomotion::app
