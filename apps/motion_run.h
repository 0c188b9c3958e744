#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "stereomotion/motion/analyse_motion.h"

namespace stereomotion::app {

/// Works out the motion of a finished RUN (or RUN/<body>) from its files and writes motion.csv,
/// motion.json and axes.csv into it: what `track` does at its end and `analyse` does again. Returns
/// the analysis; throws `OutputError` on a full disk, `UserError` for a file that cannot be read.
MotionAnalysis RunMotion(const std::filesystem::path& run, const AnalyseOptions& options = {});

/// Reads a RUN (or RUN/<body>) for its analysis; rig and body that are not in it: those that
/// run.json names, if their check sums are still the same. Throws `UserError`.
MotionData ReadRunMotion(const std::filesystem::path& run, std::size_t max_joint_frames);

/// Writes motion.csv, motion.json and axes.csv of an analysis into a folder: all three or none.
void WriteMotion(const std::filesystem::path& folder, const MotionAnalysis& analysis);

/// Spells the outcome for a person, some lines; without the warnings, which go to the log.
std::string MotionSummary(const MotionAnalysis& analysis);

/// Names a body of a run together with its motion.
struct BodyMotion {
  std::string name;
  MotionAnalysis analysis;
};

/// Finds the joint of every two bodies from their common frames and writes joint.json (of more than
/// two bodies: joint-A-B.json each) into `folder`. Returns the outcome for a person, also where two
/// bodies have no joint (nothing is written then); empty for a single body. Throws `OutputError`.
std::string RunJoints(const std::filesystem::path& folder, const std::vector<BodyMotion>& bodies);

}  // namespace stereomotion::app
