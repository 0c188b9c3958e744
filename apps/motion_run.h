#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "stereomotion/io/write_file.h"
#include "stereomotion/motion/analyse_motion.h"

namespace stereomotion::app {

/// Works out the motion of a finished RUN (or RUN/<body>) from its files and writes motion.csv,
/// motion.json and axes.csv into it: what `track` does at its end and `analyse` does again. Returns
/// the analysis; throws `OutputError` on a full disk, `UserError` for a file that cannot be read.
MotionAnalysis RunMotion(const std::filesystem::path& run, const AnalyseOptions& options = {});

/// Reads a RUN (or RUN/<body>) for its analysis; rig and body that are not in it: those that
/// run.json names, if their check sums are still the same. Throws `UserError`.
MotionData ReadRunMotion(const std::filesystem::path& run, std::size_t max_joint_frames);

/// Spells motion.csv, motion.json and axes.csv of an analysis, for `folder`; writes nothing.
std::vector<TextFile> MotionTexts(const std::filesystem::path& folder,
                                  const MotionAnalysis& analysis);

/// Spells the outcome for a person, some lines; without the warnings, which go to the log.
std::string MotionSummary(const MotionAnalysis& analysis);

/// Names a body of a run together with its motion.
struct BodyMotion {
  std::string name;
  MotionAnalysis analysis;
};

/// Holds what the joints of bodies say to a person, and their files, which are not written yet.
struct JointTexts {
  std::string summary;
  std::vector<TextFile> files;
};

/// Does what `RunJoints` does, but writes nothing.
JointTexts FindJoints(const std::filesystem::path& folder, const std::vector<BodyMotion>& bodies);

/// Finds the joint of every two bodies from their common frames and writes joint.json (of more than
/// two bodies: joint-A-B.json each) into `folder`. Returns the outcome for a person, also where two
/// bodies have no joint (nothing is written then); empty for a single body. Throws `OutputError`.
std::string RunJoints(const std::filesystem::path& folder, const std::vector<BodyMotion>& bodies);

}  // namespace stereomotion::app
