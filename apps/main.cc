#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <cstdio>
#include <exception>
#include <map>
#include <string>
#include <vector>

#include "commands.h"
#include "stereomotion/core/device_error.h"
#include "stereomotion/core/output_error.h"
#include "stereomotion/core/user_error.h"
#include "stereomotion/io/suggest.h"
#include "version.h"

namespace stereomotion::app {
namespace {

void SetUpLog(const CommonOptions& options) {
  auto logger = spdlog::stderr_color_mt("stereomotion");
  logger->set_pattern("%^%l%$: %v");
  logger->set_level(options.quiet ? spdlog::level::err
                                  : spdlog::level::from_str(options.log_level));
  spdlog::set_default_logger(logger);
}

void AddCommonOptions(CLI::App& command, CommonOptions& options) {
  command.add_flag("-q,--quiet", options.quiet, "Print errors only");
  command.add_option("--log-level", options.log_level, "How much is told on stderr")
      ->check(CLI::IsMember({"debug", "info", "warn", "error"}))
      ->capture_default_str();
}

// The one place where exceptions become exit codes.
int RunGuarded(const Run& run, const CommonOptions& options) {
  try {
    return run(options);
  } catch (const UserError& error) {
    fmt::print(stderr, "stereomotion: {}\n", error.what());
    return kWrongUse;
  } catch (const OutputError& error) {
    fmt::print(stderr, "stereomotion: {}\n", error.what());
    return kDeviceFailed;
  } catch (const DeviceError& error) {
    fmt::print(stderr, "stereomotion: {}\n", error.what());
    return kDeviceFailed;
  } catch (const std::exception& error) {
    fmt::print(stderr, "stereomotion: {} (this is a fault of the program)\n", error.what());
    return kDeviceFailed;
  }
}

// CLI11 would only say that a subcommand is required.
void RequireKnownCommand(int argc, char** argv, const std::map<std::string, Run>& commands) {
  if (argc < 2 || argv[1][0] == '-' || commands.count(argv[1]) > 0) return;
  std::vector<std::string> names;
  names.reserve(commands.size());
  for (const auto& [name, run] : commands) names.push_back(name);
  throw UserError(fmt::format("this version has no command '{}', expected one of {}{}", argv[1],
                              fmt::join(names, ", "), DidYouMean(argv[1], names)));
}

int Main(int argc, char** argv) {
  CLI::App app("Measures the motion of a rigid body with two cameras.", "stereomotion");
  app.set_version_flag("--version", std::string("stereomotion ") + kVersion);
  app.require_subcommand(1);
  app.footer("Example: stereomotion track --left rec/cam0 --right rec/cam1 --body body.yaml");
  CommonOptions options;
  options.command_line.assign(argv, argv + argc);
  const std::map<std::string, Run> commands = {
      {"calibrate", AddCalibrateCommand(app)}, {"track", AddTrackCommand(app)},
      {"analyse", AddAnalyseCommand(app)},     {"simulate", AddSimulateCommand(app)},
      {"convert", AddConvertCommand(app)},     {"print-target", AddPrintTargetCommand(app)},
      {"cameras", AddCamerasCommand(app)},     {"check", AddCheckCommand(app)},
      {"record", AddRecordCommand(app)}};
  for (const auto& [name, run] : commands) AddCommonOptions(*app.get_subcommand(name), options);
  RequireKnownCommand(argc, argv, commands);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kWrongUse;
  }
  SetUpLog(options);
  return RunGuarded(commands.at(app.get_subcommands().front()->get_name()), options);
}

}  // namespace
}  // namespace stereomotion::app

int main(int argc, char** argv) {
  try {
    return stereomotion::app::Main(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "stereomotion: %s\n", error.what());
    return stereomotion::app::kWrongUse;
  }
}
