#include "track_results.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdio>
#include <sstream>

#include "motion_run.h"
#include "stereomotion/core/output_error.h"
#include "stereomotion/io/body_folder.h"
#include "stereomotion/io/body_writer.h"
#include "stereomotion/io/rig_writer.h"
#include "stereomotion/io/run_report.h"
#include "stereomotion/io/write_file.h"

namespace stereomotion::app {
namespace {

namespace fs = std::filesystem;

const RigCamera& CameraOf(const MeasureSetup& setup, int camera) {
  return setup.rig.cameras[static_cast<std::size_t>(camera)];
}

bool IsInput(const fs::path& file, const TrackOptions& options) {
  std::error_code none;
  if (fs::equivalent(file, options.rig, none)) return true;
  return std::any_of(options.bodies.begin(), options.bodies.end(), [&](const std::string& body) {
    std::error_code no_such_file;
    return fs::equivalent(file, body, no_such_file);
  });
}

std::string BodyComment(const TrackOptions& options, std::size_t body) {
  if (!options.bodies.empty()) return "As the run used it; read from " + options.bodies[body];
  return fmt::format("Learned from {} and {}.", options.left, options.right);
}

void WarnOf(const std::string& warning, RunRecord& record) {
  spdlog::warn(warning);
  record.warnings.push_back(warning);
}

// Whatever goes wrong in the analysis, the run is measured.
template <class Act>
void OrWarn(const std::string& whose, RunRecord& record, const Act& act) {
  try {
    act();
  } catch (const OutputError&) {
    throw;
  } catch (const std::exception& error) {
    WarnOf(fmt::format("{}motion was not analysed: {} (try `stereomotion analyse` on the run)",
                       whose, error.what()),
           record);
  }
}

// Takes the blanks away that make columns in a terminal.
std::vector<std::string> Lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    std::istringstream words(line);
    std::string joined;
    for (std::string word; words >> word;) joined += (joined.empty() ? "" : " ") + word;
    if (!joined.empty()) lines.push_back(joined);
  }
  return lines;
}

std::string MostFrequentLoss(const RunSummary& summary) {
  std::string worst = "no frame pair was read";
  std::int64_t most = 0;
  for (const auto& [reason, count] : summary.lost_by_reason) {
    if (count <= most) continue;
    most = count;
    worst = fmt::format("{} of {} pairs: {}", count, summary.pairs_read, reason);
  }
  return worst;
}

}  // namespace

void CopySetup(const fs::path& folder, const TrackOptions& options, const MeasureSetup& setup) {
  std::vector<TextFile> files;
  const auto add = [&](const fs::path& file, std::string text) {
    if (!IsInput(file, options)) files.push_back({file, std::move(text)});
  };
  CalibrationRecord origin;
  origin.source = options.rig;
  add(folder / "rig.yaml", RigYaml(setup.rig, origin));
  for (std::size_t i = 0; i < setup.bodies.size(); ++i) {
    add(FolderOfBody(folder, setup.bodies, i) / "body.yaml",
        BodyYaml(setup.bodies[i], BodyComment(options, i)));
  }
  WriteFilesAtomically(files);
}

MotionOutcome AnalyseCourses(const fs::path& folder, const MeasureSetup& setup,
                             std::vector<BodyCourse>& courses, RunRecord& record) {
  MotionOutcome outcome;
  std::string& text = outcome.bodies;
  std::vector<BodyMotion> motions;
  for (std::size_t i = 0; i < courses.size(); ++i) {
    const std::string& name = setup.bodies[i].name;
    const std::string whose = courses.size() > 1 ? "body '" + name + "': " : std::string();
    OrWarn(whose, record, [&] {
      courses[i].motion = RunMotion(FolderOfBody(folder, setup.bodies, i));
      for (const auto& warning : courses[i].motion->warnings) spdlog::warn("{}{}", whose, warning);
      if (courses.size() > 1) text += name + "\n";
      text += MotionSummary(*courses[i].motion);
      motions.push_back({name, *courses[i].motion});
    });
  }
  OrWarn("joint: ", record, [&] { outcome.joints = RunJoints(folder, motions); });
  return outcome;
}

void WriteReport(const fs::path& folder, const TrackInputs& inputs, const RunRecord& record,
                 const std::vector<BodyCourse>& courses, const std::string& joints) {
  const MeasureSetup& setup = inputs.setup;
  RunReport report{record,
                   {},
                   CameraOf(setup, setup.left_camera),
                   CameraOf(setup, setup.right_camera),
                   inputs.masks,
                   Lines(joints)};
  for (const BodyCourse& course : courses) {
    report.bodies.push_back({&course.trace, course.motion ? &*course.motion : nullptr});
  }
  WriteFileAtomically(folder / "report.html", RunHtml(report));
}

int Finish(const fs::path& folder, const RunSummary& summary,
           const std::vector<BodyCourse>& courses, const MotionOutcome& motion,
           const CommonOptions& common, const std::string& problem, std::FILE* out) {
  for (const auto& warning : summary.warnings) spdlog::warn(warning);
  if (summary.interrupted) spdlog::warn("interrupted: the files hold the pairs up to here");
  std::vector<RunStatistics> statistics;
  std::int64_t poses = 0;
  for (const BodyCourse& course : courses) statistics.push_back(course.statistics);
  for (const BodySummary& body : summary.bodies) poses += body.poses;
  if (!common.quiet) {
    fmt::print(out, "{}{}{}", RunTable(summary, statistics), motion.bodies, motion.joints);
  }
  fmt::print(out, "{}\n", folder.string());
  if (!problem.empty()) {
    fmt::print(stderr, "stereomotion: {}\n", problem);
    return kDeviceFailed;
  }
  if (poses > 0 || summary.interrupted) return kDone;
  fmt::print(stderr, "stereomotion: no pose in the whole run ({}); see {}\n",
             MostFrequentLoss(summary), (folder / "poses.csv").string());
  return kNoAnswer;
}

}  // namespace stereomotion::app
