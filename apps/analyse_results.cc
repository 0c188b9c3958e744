#include "analyse_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <stdexcept>

#include "stereomotion/core/user_error.h"
#include "stereomotion/io/motion_writer.h"
#include "stereomotion/io/suggest.h"
#include "stereomotion/io/write_file.h"
#include "stereomotion/motion/filter.h"
#include "stereomotion/motion/frames_of_reference.h"

namespace stereomotion::app {
namespace {

namespace fs = std::filesystem;

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

void AddRelativeOf(const AnalyseArguments& arguments, const std::vector<BodyMotion>& bodies,
                   const AnalyseBody& body, const PoseSeries& series,
                   std::vector<TextFile>& files) {
  if (!arguments.relative_to.empty() && body.name == arguments.relative_to) return;
  try {
    const PoseSeries relative = Relative(arguments, bodies, series);
    if (!arguments.relative_to.empty()) {
      files.push_back({body.folder / "relative.csv", PosesCsv(relative)});
    }
    if (arguments.angles.empty()) return;
    const AngleSequence sequence = AngleSequence::Parse(arguments.angles);
    std::array<std::string, 3> names;
    for (std::size_t k = 0; k < 3; ++k) {
      names[k] = fmt::format("angle{}_{}", k + 1, sequence.axes[k]);
    }
    files.push_back(
        {body.folder / "angles.csv", AnglesCsv(relative, AnglesOf(relative, sequence), names)});
  } catch (const std::invalid_argument& error) {
    throw UserError(std::string("--angles, --relative-to: ") + error.what());
  }
}

// All names that files of joints between these bodies can have.
std::vector<std::string> JointResultNames(const AnalyseInputs& inputs) {
  std::vector<std::string> names = {"joint.json", "joint_angles.csv"};
  for (const AnalyseBody& first : inputs.bodies) {
    for (const AnalyseBody& second : inputs.bodies) {
      names.push_back(fmt::format("joint-{}-{}.json", first.name, second.name));
    }
  }
  return names;
}

}  // namespace

std::string AddFiltered(const AnalyseArguments& arguments, const fs::path& folder,
                        const MotionAnalysis& analysis, std::vector<TextFile>& files) {
  try {
    const FilteredSeries filtered = FilterPoses(analysis.series, MakeFilterOptions(arguments));
    const SpinCenter* center = analysis.spin.center ? &*analysis.spin.center : nullptr;
    files.push_back({folder / "filtered.csv", FilteredCsv(filtered, center)});
    return filtered.description;
  } catch (const std::invalid_argument& error) {
    throw UserError(std::string("--filter: ") + error.what());
  }
}

void AddRelative(const AnalyseArguments& arguments, const AnalyseInputs& inputs,
                 const std::vector<BodyMotion>& bodies, std::vector<TextFile>& files) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    AddRelativeOf(arguments, bodies, inputs.bodies[i], bodies[i].analysis.series, files);
  }
}

void AddJointAngles(const AnalyseArguments& arguments, const fs::path& folder,
                    const std::vector<BodyMotion>& bodies, std::vector<TextFile>& files) {
  for (const JointConvention& convention : JointConventions()) {
    if (convention.name != arguments.joint) continue;
    const std::size_t base = bodies[1].name == arguments.relative_to ? 1 : 0;
    const PoseSeries relative =
        RelativeToBody(bodies[base].analysis.series, bodies[1 - base].analysis.series);
    const BodySide side = arguments.side == "left" ? BodySide::kLeft : BodySide::kRight;
    std::array<std::string, 3> names;
    for (std::size_t k = 0; k < 3; ++k) names[k] = convention.angle_names[k];
    files.push_back({folder / "joint_angles.csv",
                     AnglesCsv(relative, JointAngles(relative, convention, side), names)});
  }
}

std::vector<fs::path> StaleResults(const AnalyseArguments& arguments, const AnalyseInputs& inputs,
                                   const std::vector<TextFile>& files) {
  std::vector<fs::path> stale;
  bool analysed = false;
  for (const AnalyseBody& body : inputs.bodies) {
    std::error_code ignored;
    if (!fs::exists(body.folder / "motion.json", ignored)) continue;  // files of somebody else
    analysed = true;
    for (const char* name : {"filtered.csv", "relative.csv", "angles.csv"}) {
      stale.push_back(body.folder / name);
    }
  }
  if (analysed) {
    for (const std::string& name : JointResultNames(inputs)) stale.push_back(inputs.folder / name);
  }
  const auto kept = [&](const fs::path& file) {
    std::error_code ignored;
    if (!fs::is_regular_file(file, ignored) || fs::equivalent(file, arguments.input, ignored)) {
      return true;
    }
    return std::any_of(files.begin(), files.end(),
                       [&](const TextFile& made) { return made.path == file; });
  };
  stale.erase(std::remove_if(stale.begin(), stale.end(), kept), stale.end());
  return stale;
}

}  // namespace stereomotion::app
