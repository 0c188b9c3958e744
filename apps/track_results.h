#pragma once

#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "commands.h"
#include "run_statistics.h"
#include "stereomotion/io/run_record.h"
#include "stereomotion/io/run_trace.h"
#include "stereomotion/motion/analyse_motion.h"
#include "track_inputs.h"

namespace stereomotion::app {

/// Holds what a run keeps of one body for its end.
struct BodyCourse {
  explicit BodyCourse(const Body& body) : trace(body) {}
  RunStatistics statistics;
  RunTrace trace;
  std::optional<MotionAnalysis> motion;
};

/// Writes rig.yaml and body.yaml as they are used into RUN, so that `analyse` needs nothing else;
/// never over what the user gave. Throws `OutputError`.
void CopySetup(const std::filesystem::path& folder, const TrackOptions& options,
               const MeasureSetup& setup);

/// Holds what the motion came to, for a person.
struct MotionOutcome {
  std::string bodies, joints;  ///< some lines each
};

/// Analyses each body's motion, and the joints of several, into RUN; returns the outcome. An
/// analysis that fails becomes a warning of the record; a full disk throws `OutputError`.
MotionOutcome AnalyseCourses(const std::filesystem::path& folder, const MeasureSetup& setup,
                             std::vector<BodyCourse>& courses, RunRecord& record);

/// Writes report.html. Throws `OutputError`.
void WriteReport(const std::filesystem::path& folder, const TrackInputs& inputs,
                 const RunRecord& record, const std::vector<BodyCourse>& courses,
                 const std::string& joints);

/// Tells the end of a run on `out`; returns the exit code. `problem`: why live cameras or their
/// recording did not end as asked, or empty.
int Finish(const std::filesystem::path& folder, const RunSummary& summary,
           const std::vector<BodyCourse>& courses, const MotionOutcome& motion,
           const CommonOptions& common, const std::string& problem, std::FILE* out);

}  // namespace stereomotion::app
