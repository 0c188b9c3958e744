#include "analyse_results.h"

#include <fmt/format.h>

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

void WriteRelativeOf(const AnalyseArguments& arguments, const std::vector<BodyMotion>& bodies,
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

}  // namespace

std::string WriteFiltered(const AnalyseArguments& arguments, const fs::path& folder,
                          const MotionAnalysis& analysis) {
  try {
    const FilteredSeries filtered = FilterPoses(analysis.series, MakeFilterOptions(arguments));
    const SpinCenter* center = analysis.spin.center ? &*analysis.spin.center : nullptr;
    WriteFileAtomically(folder / "filtered.csv", FilteredCsv(filtered, center));
    return filtered.description;
  } catch (const std::invalid_argument& error) {
    throw UserError(std::string("--filter: ") + error.what());
  }
}

void WriteRelative(const AnalyseArguments& arguments, const AnalyseInputs& inputs,
                   const std::vector<BodyMotion>& bodies) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    WriteRelativeOf(arguments, bodies, inputs.bodies[i], bodies[i].analysis.series);
  }
}

void WriteJointAngles(const AnalyseArguments& arguments, const fs::path& folder,
                      const std::vector<BodyMotion>& bodies) {
  for (const JointConvention& convention : JointConventions()) {
    if (convention.name != arguments.joint) continue;
    const std::size_t base = bodies[1].name == arguments.relative_to ? 1 : 0;
    const PoseSeries relative =
        RelativeToBody(bodies[base].analysis.series, bodies[1 - base].analysis.series);
    const BodySide side = arguments.side == "left" ? BodySide::kLeft : BodySide::kRight;
    std::array<std::string, 3> names;
    for (std::size_t k = 0; k < 3; ++k) names[k] = convention.angle_names[k];
    WriteFileAtomically(folder / "joint_angles.csv",
                        AnglesCsv(relative, JointAngles(relative, convention, side), names));
  }
}

}  // namespace stereomotion::app
