#include "motion_run.h"

#include <fmt/format.h>

#include "stereomotion/capture/sha256.h"
#include "stereomotion/core/user_error.h"
#include "stereomotion/io/motion_reader.h"
#include "stereomotion/io/motion_writer.h"
#include "stereomotion/io/run_reader.h"
#include "stereomotion/io/write_file.h"
#include "stereomotion/motion/joint.h"

namespace stereomotion::app {
namespace {

namespace fs = std::filesystem;

// Runs of older versions hold no copies of rig and body: those that run.json names, if they are
// still the same.
fs::path OriginalInput(const fs::path& run, const std::string& role) {
  const fs::path copy = run / (role + ".yaml");
  const fs::path root = fs::exists(run / "run.json") ? run : (run / "..").lexically_normal();
  const RunOrigin origin = ReadRunOrigin(root);
  const RunInput* input = origin.Input(role);
  std::error_code ignored;
  if (input == nullptr || !fs::is_regular_file(input->path, ignored)) {
    throw UserError(
        fmt::format("{}: no such file, expected a copy of the {} that the run was "
                    "measured with; copy it there{}",
                    copy.string(), role, input == nullptr ? "" : " (it was " + input->path + ")"));
  }
  if (const std::string found = Sha256OfFile(input->path);
      !input->sha256.empty() && found != input->sha256) {
    throw UserError(fmt::format(
        "{}: found SHA-256 {}, expected {} as {} says: the {} was changed "
        "after the run; copy the original to {}",
        input->path, found, input->sha256, (root / "run.json").string(), role, copy.string()));
  }
  return input->path;
}

MotionFiles FilesOf(const fs::path& run) {
  MotionFiles files = MotionFiles::In(run);
  if (files.balls.empty()) return files;
  if (files.rig.empty()) files.rig = OriginalInput(run, "rig");
  if (files.body.empty()) files.body = OriginalInput(run, "body");
  return files;
}

std::string_view JointFailureText(JointFailure failure) {
  switch (failure) {
    case JointFailure::kTooFewPoses:
      return "fewer than three frames have a pose of both";
    case JointFailure::kOneRod:
      return "one of them is a single rod, whose turn about itself is not seen";
    case JointFailure::kNoRelativeRotation:
      return "they do not turn against each other beyond the noise";
  }
  return "";
}

}  // namespace

std::vector<TextFile> MotionTexts(const fs::path& folder, const MotionAnalysis& analysis) {
  return {{folder / "motion.csv", MotionCsv(analysis)},
          {folder / "motion.json", MotionJson(analysis)},
          {folder / "axes.csv", AxesCsv(analysis)}};
}

MotionData ReadRunMotion(const fs::path& run, std::size_t max_joint_frames) {
  return ReadMotionData(FilesOf(run), max_joint_frames);
}

MotionAnalysis RunMotion(const fs::path& run, const AnalyseOptions& options) {
  MotionAnalysis analysis = AnalyseMotion(ReadRunMotion(run, options.max_joint_frames), options);
  WriteFilesAtomically(MotionTexts(run, analysis));
  return analysis;
}

JointTexts FindJoints(const fs::path& folder, const std::vector<BodyMotion>& bodies) {
  JointTexts texts;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    for (std::size_t j = i + 1; j < bodies.size(); ++j) {
      const std::string &first = bodies[i].name, &second = bodies[j].name;
      const auto joint = FindJoint(bodies[i].analysis.series, bodies[j].analysis.series);
      const std::string label = fmt::format("joint of {} and {}:", first, second);
      texts.summary +=
          fmt::format("  {:<25} {}\n", label,
                      joint ? joint->verdict : std::string(JointFailureText(joint.error())));
      if (!joint) continue;
      const std::string name =
          bodies.size() == 2 ? "joint.json" : fmt::format("joint-{}-{}.json", first, second);
      texts.files.push_back({folder / name, JointJson(*joint, first, second)});
    }
  }
  return texts;
}

std::string RunJoints(const fs::path& folder, const std::vector<BodyMotion>& bodies) {
  const JointTexts joints = FindJoints(folder, bodies);
  WriteFilesAtomically(joints.files);
  return joints.summary;
}

}  // namespace stereomotion::app
