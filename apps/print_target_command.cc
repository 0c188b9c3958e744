#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>

#include "commands.h"
#include "stereomotion/calibration/print_target.h"
#include "stereomotion/core/user_error.h"
#include "stereomotion/io/frame_file.h"
#include "stereomotion/io/write_file.h"

namespace stereomotion::app {
namespace {

namespace fs = std::filesystem;

struct PrintTargetOptions {
  std::string frame;
  std::string output = "board.svg";
  std::string page = "none";
  bool force = false;
};

struct Paper {
  const char* name;
  double short_mm, long_mm;
};
constexpr Paper kPapers[] = {{"a4", 210, 297}, {"a3", 297, 420}, {"letter", 215.9, 279.4}};

void RefuseWhatIsNotPrinted(const PrintTargetOptions& options, const Target& target) {
  if (target.type == TargetType::kControlPoints) {
    throw UserError(options.frame +
                    ": target.type: found control_points, expected a board: a frame of control "
                    "points is built and surveyed, not printed (docs/calibration.md)");
  }
  if (target.type == TargetType::kWand) {
    throw UserError(options.frame +
                    ": target.type: found wand, expected a board: a wand is a straight rod with "
                    "balls at measured places, not printed (docs/calibration.md)");
  }
  if (target.type == TargetType::kCircleGrid && target.ball_diameter_mm == 0) {
    throw UserError(options.frame +
                    ": target: found no circle_diameter_mm, expected it: the "
                    "print needs the circles' size");
  }
}

// Nothing: the board does not fit, and `problem` says what it needs.
std::optional<std::string> DrawOn(const Target& target, double width_mm, double height_mm,
                                  std::string& problem) {
  try {
    PrintPage page;
    page.width_mm = width_mm;
    page.height_mm = height_mm;
    return TargetSvg(target, page);
  } catch (const std::invalid_argument& error) {
    problem = error.what();
    return std::nullopt;
  }
}

// Upright paper first, then lying.
std::string Draw(const PrintTargetOptions& options, const Target& target) {
  std::string problem;
  std::optional<std::string> svg;
  if (options.page == "none") svg = DrawOn(target, 0, 0, problem);
  for (const Paper& paper : kPapers) {
    if (options.page != paper.name) continue;
    svg = DrawOn(target, paper.short_mm, paper.long_mm, problem);
    if (!svg) svg = DrawOn(target, paper.long_mm, paper.short_mm, problem);
  }
  if (svg) return *svg;
  throw UserError(
      fmt::format("{}: {} (--page {}); give --page none for a print shop, or print a "
                  "smaller board",
                  options.frame, problem, options.page));
}

void CheckOutput(const PrintTargetOptions& options) {
  const fs::path output = options.output;
  std::error_code error;
  if (fs::equivalent(options.frame, output, error)) {
    throw UserError(options.output + ": is the input, expected another --output");
  }
  if (fs::is_directory(output, error)) {
    throw UserError(options.output + ": is a folder, expected a file (--output)");
  }
  if (fs::is_regular_file(output, error) && !options.force) {
    throw UserError(options.output + ": exists; give --force to overwrite, or another --output");
  }
}

int RunPrintTarget(const PrintTargetOptions& options) {
  const Target target = ReadFrameTarget(options.frame);
  RefuseWhatIsNotPrinted(options, target);
  const std::string svg = Draw(options, target);
  CheckOutput(options);
  WriteFileAtomically(options.output, svg);
  spdlog::info("print it at 100 %, then measure the bar: it must be 100 mm long");
  fmt::print("{}\n", options.output);
  return kDone;
}

}  // namespace

Run AddPrintTargetCommand(CLI::App& app) {
  auto options = std::make_shared<PrintTargetOptions>();
  CLI::App* print =
      app.add_subcommand("print-target", "Draws the board of a frame.yaml in true millimetres");
  print->add_option("frame", options->frame, "frame.yaml; its `target:` is enough")->required();
  print->add_option("--output", options->output, "The drawing, SVG")->capture_default_str();
  print
      ->add_option("--page", options->page,
                   "Paper, upright or lying; none: as large as the board needs")
      ->check(CLI::IsMember({"a4", "a3", "letter", "none"}))
      ->capture_default_str();
  print->add_flag("--force", options->force, "Overwrite an existing output");
  print->footer("Example: stereomotion print-target calib/frame_tags.yaml --output board.svg");
  return [options](const CommonOptions&) { return RunPrintTarget(*options); };
}

}  // namespace stereomotion::app
