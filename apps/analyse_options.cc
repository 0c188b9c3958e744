#include "analyse_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "number_within.h"
#include "stereomotion/core/user_error.h"
#include "stereomotion/io/suggest.h"
#include "stereomotion/motion/frames_of_reference.h"

namespace stereomotion::app {
namespace {

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

void CheckAngles(const AnalyseArguments& arguments) {
  if (arguments.angles.empty()) return;
  try {
    static_cast<void>(AngleSequence::Parse(arguments.angles));
  } catch (const std::invalid_argument& error) {
    throw UserError(std::string("--angles: ") + error.what());
  }
}

void CheckJoint(const AnalyseArguments& arguments) {
  if (arguments.joint.empty()) return;
  std::vector<std::string> known;
  for (const JointConvention& convention : JointConventions()) {
    known.emplace_back(convention.name);
  }
  if (std::find(known.begin(), known.end(), arguments.joint) != known.end()) return;
  throw UserError(fmt::format("--joint: found '{}', expected one of {}{}", arguments.joint,
                              fmt::join(known, ", "), DidYouMean(arguments.joint, known)));
}

// An option that would change nothing is a mistake.
void CheckFilter(const AnalyseArguments& arguments) {
  if (!arguments.butterworth_told || arguments.filter == "butterworth") return;
  throw UserError("--cutoff-hz, --order: need --filter butterworth beside them");
}

void AddMethodOptions(CLI::App& analyse, AnalyseArguments& arguments) {
  constexpr double kSmallest = 1e-9, kLargest = 1e12;
  constexpr int kHighestOrder = 20;
  const auto told = [&arguments](const std::string&) { arguments.butterworth_told = true; };
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
      ->each(told)
      ->capture_default_str();
  analyse.add_option("--order", arguments.order, "Butterworth: of both passes together, even")
      ->check(WholeNumberWithin(2, kHighestOrder))
      ->each(told)
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
  CLI::Option* joint =
      analyse
          .add_option(
              "--joint", arguments.joint,
              "Write joint_angles.csv of two bodies after the ISB: knee, hip, ankle, spine, "
              "shoulder, elbow, wrist; the proximal body is the first, or --relative-to")
          ->check(NotEmpty());
  analyse.add_option("--side", arguments.side, "Side of the person, for --joint")
      ->check(CLI::IsMember({"right", "left"}))
      ->needs(joint)
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

void AddAnalyseOptions(CLI::App& analyse, AnalyseArguments& arguments) {
  analyse
      .add_option("input", arguments.input,
                  "RUN that `track` wrote, CSV file of poses, or C3D/N3D file of markers")
      ->required()
      ->check(NotEmpty());
  AddMethodOptions(analyse, arguments);
  AddFrameOptions(analyse, arguments);
  AddInputOptions(analyse, arguments);
  analyse
      .add_option("--output", arguments.output,
                  "Folder for the results; RUN itself, or NAME-motion, by default")
      ->check(NotEmpty());
  analyse.add_flag("--force", arguments.force, "Replace an analysis that is there");
  analyse.footer(
      "Examples:\n"
      "  stereomotion analyse run-20260101-120000\n"
      "  stereomotion analyse run --law uniform --filter butterworth --cutoff-hz 6\n"
      "  stereomotion analyse run --relative-to thigh --joint knee\n"
      "  stereomotion analyse poses.csv --pose-sigma-deg 0.1 --pose-sigma-mm 0.3 --output pivot\n"
      "  stereomotion analyse trial.c3d --points 'Probe*' --output probe");
}

AnalyseOptions MakeAnalyseOptions(const AnalyseArguments& arguments) {
  AnalyseOptions options;
  if (!arguments.law.empty()) options.center.law = IndexOf<PathLaw>(LawNames(), arguments.law);
  if (arguments.path_psd_mm2_s3 > 0) {
    if (arguments.law != "free") throw UserError("--path-psd: needs --law free beside it");
    options.center.path_psd_mm2_s3 = arguments.path_psd_mm2_s3;
  }
  CheckFilter(arguments);
  CheckAngles(arguments);
  CheckJoint(arguments);
  options.velocity.max_gap_s = arguments.max_gap_s;
  return options;
}

FilterOptions MakeFilterOptions(const AnalyseArguments& arguments) {
  FilterOptions options;
  options.method = IndexOf<FilterMethod>(FilterNames(), arguments.filter);
  options.cutoff_hz = arguments.cutoff_hz;
  options.order = arguments.order;
  options.max_gap_s = arguments.max_gap_s;
  return options;
}

}  // namespace stereomotion::app
