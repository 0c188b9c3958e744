#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "stereomotion/motion/analyse_motion.h"

namespace stereomotion::app {

/// Works out the motion of a finished RUN (or RUN/<body>) from its files and writes motion.csv,
/// motion.json and axes.csv into it: what `track` does at its end and `analyse` does again. Returns
/// the analysis; throws `OutputError` on a full disk.
MotionAnalysis RunMotion(const std::filesystem::path& run, const AnalyseOptions& options = {});

/// Spells the outcome for a person, some lines.
std::string MotionSummary(const MotionAnalysis& analysis);

}  // namespace stereomotion::app
