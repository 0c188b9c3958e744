#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <memory>

#include "analyse_inputs.h"
#include "analyse_options.h"
#include "analyse_results.h"
#include "commands.h"
#include "motion_run.h"
#include "stereomotion/core/user_error.h"
#include "stereomotion/io/output_error.h"
#include "stereomotion/io/run_analysis.h"

namespace stereomotion::app {
namespace {

namespace fs = std::filesystem;

// An analysis of a RUN replaces its own files there; anywhere else nothing is overwritten unasked.
void PrepareFolders(const AnalyseArguments& arguments, const AnalyseInputs& inputs) {
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
    fs::create_directories(body.folder, error);
    if (error) throw OutputError(body.folder.string() + ": " + error.message());
  }
}

bool HasAnswer(const std::vector<BodyMotion>& bodies) {
  for (const BodyMotion& body : bodies) {
    if (!body.analysis.spin.laws.empty()) return true;
  }
  return false;
}

// Motion of every body, written and told as it comes. Returns the filter with all its numbers.
std::string AnalyseBodies(const AnalyseArguments& arguments, const AnalyseInputs& inputs,
                          const AnalyseOptions& options, bool quiet,
                          std::vector<BodyMotion>& bodies) {
  std::string filter;
  for (const AnalyseBody& body : inputs.bodies) {
    bodies.push_back({body.name, AnalyseMotion(body.data, options)});
    const MotionAnalysis& analysis = bodies.back().analysis;
    WriteMotion(body.folder, analysis);
    if (!arguments.filter.empty()) filter = WriteFiltered(arguments, body.folder, analysis);
    if (!quiet) {
      if (inputs.bodies.size() > 1) fmt::print("{}\n", body.name);
      fmt::print("{}", MotionSummary(analysis));
    }
    for (const std::string& warning : analysis.warnings) spdlog::warn(warning);
  }
  return filter;
}

int RunAnalyse(const AnalyseArguments& arguments, const CommonOptions& common) {
  const AnalyseOptions options = MakeAnalyseOptions(arguments);
  const AnalyseInputs inputs = LoadAnalyseInputs(arguments, options);
  for (const std::string& warning : inputs.warnings) spdlog::warn(warning);
  PrepareFolders(arguments, inputs);
  std::vector<BodyMotion> bodies;
  const std::string filter = AnalyseBodies(arguments, inputs, options, common.quiet, bodies);
  WriteRelative(arguments, inputs, bodies);
  const std::string joints = RunJoints(inputs.folder, bodies);
  WriteJointAngles(arguments, inputs.folder, bodies);
  if (inputs.is_run && arguments.output.empty()) {
    NoteAnalysis(inputs.folder, common.command_line, filter);
  }
  if (!common.quiet) fmt::print("{}", joints);
  if (!common.quiet && !filter.empty()) fmt::print("  {:<26}{}\n", "filter", filter);
  fmt::print("{}\n", inputs.folder.string());
  return HasAnswer(bodies) ? kDone : kNoAnswer;
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
