#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <charconv>
#include <memory>
#include <stdexcept>

#include "analyse_inputs.h"
#include "commands.h"
#include "motion_run.h"
#include "number_within.h"
#include "stereomotion/core/user_error.h"
#include "stereomotion/io/motion_writer.h"
#include "stereomotion/io/output_error.h"
#include "stereomotion/io/run_analysis.h"
#include "stereomotion/io/suggest.h"
#include "stereomotion/io/write_file.h"
#include "stereomotion/motion/filter.h"
#include "stereomotion/motion/frames_of_reference.h"

namespace stereomotion::app {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string>& LawNames() {
  static const std::vector<std::string> names = {"fixed", "uniform", "accelerated", "free"};
  return names;
}

const std::vector<std::string>& FilterNames() {
  static const std::vector<std::string> names = {"butterworth", "spline", "rts"};
  return names;
}

template <class Enum>
Enum IndexOf(const std::vector<std::string>& names, const std::string& name) {
  return static_cast<Enum>(std::find(names.begin(), names.end(), name) - names.begin());
}

AnalyseOptions MakeOptions(const AnalyseArguments& arguments) {
  AnalyseOptions options;
  if (!arguments.law.empty()) options.center.law = IndexOf<PathLaw>(LawNames(), arguments.law);
  if (arguments.path_psd_mm2_s3 > 0) {
    if (arguments.law != "free") throw UserError("--path-psd: needs --law free beside it");
    options.center.path_psd_mm2_s3 = arguments.path_psd_mm2_s3;
  }
  options.velocity.max_gap_s = arguments.max_gap_s;
  return options;
}

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

std::string WriteFiltered(const AnalyseArguments& arguments, const fs::path& folder,
                          const MotionAnalysis& analysis) {
  FilterOptions options;
  options.method = IndexOf<FilterMethod>(FilterNames(), arguments.filter);
  options.cutoff_hz = arguments.cutoff_hz;
  options.order = arguments.order;
  options.max_gap_s = arguments.max_gap_s;
  try {
    const FilteredSeries filtered = FilterPoses(analysis.series, options);
    const SpinCenter* center = analysis.spin.center ? &*analysis.spin.center : nullptr;
    WriteFileAtomically(folder / "filtered.csv", FilteredCsv(filtered, center));
    return filtered.description;
  } catch (const std::invalid_argument& error) {
    throw UserError(std::string("--filter: ") + error.what());
  }
}

// A frame number, or the name of a body.
PoseSeries Relative(const AnalyseArguments& arguments, const std::vector<BodyMotion>& bodies,
                    const PoseSeries& series) {
  const std::string& to = arguments.relative_to;
  if (to.empty()) return series;
  std::vector<std::string> names;
  for (const BodyMotion& body : bodies) {
    if (body.name == to) return RelativeToBody(body.analysis.series, series);
    names.push_back(body.name);
  }
  std::int64_t frame = -1;
  const auto [end, error] = std::from_chars(to.data(), to.data() + to.size(), frame);
  if (error != std::errc() || end != to.data() + to.size()) {
    throw UserError(
        fmt::format("--relative-to: found '{}', expected a frame number or a body "
                    "among {}{}",
                    to, fmt::join(names, ", "), DidYouMean(to, names)));
  }
  for (std::size_t i = 0; i < series.size(); ++i) {
    if (series[i].frame == frame && series[i].measured) return RelativeToFrame(series, i);
  }
  throw UserError(fmt::format("--relative-to: frame {} has no pose, expected one that has", frame));
}

void WriteAngles(const AnalyseArguments& arguments, const std::vector<BodyMotion>& bodies,
                 const AnalyseBody& body, const PoseSeries& series) {
  if (!arguments.relative_to.empty() && body.name == arguments.relative_to) return;
  try {
    const PoseSeries relative = Relative(arguments, bodies, series);
    if (!arguments.relative_to.empty()) {
      WriteFileAtomically(body.folder / "relative.csv", PosesCsv(relative));
    }
    if (arguments.angles.empty()) return;
    const AngleSequence sequence = AngleSequence::Parse(arguments.angles);
    std::array<std::string, 3> names;
    for (std::size_t k = 0; k < 3; ++k) {
      names[k] = fmt::format("angle{}_{}", k + 1, sequence.axes[k]);
    }
    WriteFileAtomically(body.folder / "angles.csv",
                        AnglesCsv(relative, AnglesOf(relative, sequence), names));
  } catch (const std::invalid_argument& error) {
    throw UserError(std::string("--angles, --relative-to: ") + error.what());
  }
}

// The base (proximal) body is the one of --relative-to, else the first.
void WriteJointAngles(const AnalyseArguments& arguments, const fs::path& folder,
                      const std::vector<BodyMotion>& bodies) {
  if (arguments.joint.empty()) return;
  if (bodies.size() != 2) {
    throw UserError(
        fmt::format("--joint: found {} bodies, expected two (proximal and distal)", bodies.size()));
  }
  std::vector<std::string> known;
  for (const JointConvention& convention : JointConventions()) {
    known.emplace_back(convention.name);
    if (convention.name != arguments.joint) continue;
    const std::size_t base = bodies[1].name == arguments.relative_to ? 1 : 0;
    const PoseSeries relative =
        RelativeToBody(bodies[base].analysis.series, bodies[1 - base].analysis.series);
    const BodySide side = arguments.side == "left" ? BodySide::kLeft : BodySide::kRight;
    std::array<std::string, 3> names;
    for (std::size_t k = 0; k < 3; ++k) names[k] = convention.angle_names[k];
    WriteFileAtomically(folder / "joint_angles.csv",
                        AnglesCsv(relative, JointAngles(relative, convention, side), names));
    return;
  }
  throw UserError(fmt::format("--joint: found '{}', expected one of {}{}", arguments.joint,
                              fmt::join(known, ", "), DidYouMean(arguments.joint, known)));
}

bool HasAnswer(const std::vector<BodyMotion>& bodies) {
  for (const BodyMotion& body : bodies) {
    if (!body.analysis.spin.laws.empty()) return true;
  }
  return false;
}

int RunAnalyse(const AnalyseArguments& arguments, const CommonOptions& common) {
  const AnalyseOptions options = MakeOptions(arguments);
  const AnalyseInputs inputs = LoadAnalyseInputs(arguments, options);
  for (const std::string& warning : inputs.warnings) spdlog::warn(warning);
  PrepareFolders(arguments, inputs);
  std::vector<BodyMotion> bodies;
  std::string filter;
  for (const AnalyseBody& body : inputs.bodies) {
    bodies.push_back({body.name, AnalyseMotion(body.data, options)});
    const MotionAnalysis& analysis = bodies.back().analysis;
    WriteMotion(body.folder, analysis);
    if (!arguments.filter.empty()) filter = WriteFiltered(arguments, body.folder, analysis);
    if (!common.quiet) {
      if (inputs.bodies.size() > 1) fmt::print("{}\n", body.name);
      fmt::print("{}", MotionSummary(analysis));
    }
    for (const std::string& warning : analysis.warnings) spdlog::warn(warning);
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    WriteAngles(arguments, bodies, inputs.bodies[i], bodies[i].analysis.series);
  }
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

void AddMethodOptions(CLI::App& analyse, AnalyseArguments& arguments) {
  constexpr double kSmallest = 1e-9, kLargest = 1e12;
  constexpr int kHighestOrder = 20;
  analyse
      .add_option("--law", arguments.law,
                  "How the spin centre moves, if you know it; else the evidence chooses")
      ->check(CLI::IsMember(LawNames()));
  analyse
      .add_option("--path-psd", arguments.path_psd_mm2_s3,
                  "With --law free: power spectral density of the centre's acceleration, mm²/s³")
      ->check(NumberWithin(kSmallest, kLargest));
  analyse.add_option("--filter", arguments.filter, "Write filtered.csv by this filter")
      ->check(CLI::IsMember(FilterNames()));
  analyse
      .add_option("--cutoff-hz", arguments.cutoff_hz, "Butterworth: -3 dB of both passes together")
      ->check(NumberWithin(kSmallest, kLargest))
      ->capture_default_str();
  analyse.add_option("--order", arguments.order, "Butterworth: of both passes together, even")
      ->check(WholeNumberWithin(2, kHighestOrder))
      ->capture_default_str();
  analyse
      .add_option("--max-gap", arguments.max_gap_s,
                  "Gaps up to so many seconds are filled and flagged")
      ->check(NumberWithin(0, kLargest))
      ->capture_default_str();
}

void AddFrameOptions(CLI::App& analyse, AnalyseArguments& arguments) {
  analyse
      .add_option("--relative-to", arguments.relative_to,
                  "Write relative.csv: poses relative to this frame (a number) or body")
      ->check(NotEmpty());
  analyse
      .add_option("--angles", arguments.angles,
                  "Write angles.csv: Euler or Cardan angles by this sequence; zxy about the "
                  "turned axes, ZXY about the fixed ones")
      ->check(NotEmpty());
  analyse
      .add_option("--joint", arguments.joint,
                  "Write joint_angles.csv of two bodies after the ISB: knee, hip, ankle, spine, "
                  "shoulder, elbow, wrist; the proximal body is the first, or --relative-to")
      ->check(NotEmpty());
  analyse.add_option("--side", arguments.side, "Side of the person, for --joint")
      ->check(CLI::IsMember({"right", "left"}))
      ->capture_default_str();
}

void AddInputOptions(CLI::App& analyse, AnalyseArguments& arguments) {
  constexpr double kSmallest = 1e-9, kLargest = 1e6;
  analyse
      .add_option("--points", arguments.points,
                  "C3D: the points of one rigid body, by label, * for any text: 'Probe*' or "
                  "A,B,C; again for another body; all by default")
      ->check(NotEmpty())
      ->delimiter('\0');
  analyse
      .add_option("--point-sigma-mm", arguments.point_sigma_mm,
                  "C3D: standard uncertainty of a coordinate; else from the rigid fit")
      ->check(NumberWithin(kSmallest, kLargest));
  analyse
      .add_option("--pose-sigma-deg", arguments.pose_sigma_deg,
                  "Standard uncertainty of a rotation, of poses without covariance")
      ->check(NumberWithin(kSmallest, kLargest));
  analyse
      .add_option("--pose-sigma-mm", arguments.pose_sigma_mm,
                  "Standard uncertainty of a translation, of poses without covariance")
      ->check(NumberWithin(kSmallest, kLargest));
}

}  // namespace

Run AddAnalyseCommand(CLI::App& app) {
  auto arguments = std::make_shared<AnalyseArguments>();
  CLI::App* analyse = app.add_subcommand(
      "analyse", "Motion, spin centre, axes and filters from a RUN, poses or markers");
  analyse
      ->add_option("input", arguments->input,
                   "RUN that `track` wrote, CSV file of poses, or C3D/N3D file of markers")
      ->required()
      ->check(NotEmpty());
  AddMethodOptions(*analyse, *arguments);
  AddFrameOptions(*analyse, *arguments);
  AddInputOptions(*analyse, *arguments);
  analyse->add_option("--output", arguments->output,
                      "Folder for the results; RUN itself, or NAME-motion, by default");
  analyse->add_flag("--force", arguments->force, "Replace an analysis that is there");
  analyse->footer(
      "Examples:\n"
      "  stereomotion analyse run-20260101-120000\n"
      "  stereomotion analyse run --law uniform --filter butterworth --cutoff-hz 6\n"
      "  stereomotion analyse run --relative-to thigh --joint knee\n"
      "  stereomotion analyse poses.csv --pose-sigma-deg 0.1 --pose-sigma-mm 0.3 --output pivot\n"
      "  stereomotion analyse trial.c3d --points 'Probe*' --output probe");
  return [arguments](const CommonOptions& common) { return RunAnalyse(*arguments, common); };
}

}  // namespace stereomotion::app
