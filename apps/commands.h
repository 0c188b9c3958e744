#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

namespace stereomotion::app {

/// Exit codes of the program (docs/formats.md).
enum ExitCode { kDone = 0, kNoAnswer = 1, kWrongUse = 2, kDeviceFailed = 3 };

/// What every subcommand is told besides its own options.
struct CommonOptions {
  std::vector<std::string> command_line;
  std::string log_level = "info";
  bool quiet = false;
};

/// Runs a subcommand after parsing; returns its exit code.
using Run = std::function<int(const CommonOptions&)>;

// Each adds its subcommand with its options to `app`; the result runs it.
Run AddCalibrateCommand(CLI::App& app);
Run AddTrackCommand(CLI::App& app);
Run AddAnalyseCommand(CLI::App& app);
Run AddSimulateCommand(CLI::App& app);
Run AddConvertCommand(CLI::App& app);
Run AddPrintTargetCommand(CLI::App& app);
Run AddCamerasCommand(CLI::App& app);
Run AddCheckCommand(CLI::App& app);
Run AddRecordCommand(CLI::App& app);

}  // namespace stereomotion::app
