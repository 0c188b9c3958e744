#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analyse_inputs.h"
#include "analyse_options.h"
#include "motion_run.h"

namespace stereomotion::app {

/// Writes filtered.csv of a body. Returns the filter with all its numbers; throws `UserError` where
/// it cannot filter this series.
std::string WriteFiltered(const AnalyseArguments& arguments, const std::filesystem::path& folder,
                          const MotionAnalysis& analysis);

/// Writes what --relative-to and --angles ask for, into each body's folder: relative.csv,
/// angles.csv. Throws `UserError`.
void WriteRelative(const AnalyseArguments& arguments, const AnalyseInputs& inputs,
                   const std::vector<BodyMotion>& bodies);

/// Writes joint_angles.csv of two bodies by the convention of --joint; the base (proximal) body is
/// the one of --relative-to, else the first.
void WriteJointAngles(const AnalyseArguments& arguments, const std::filesystem::path& folder,
                      const std::vector<BodyMotion>& bodies);

}  // namespace stereomotion::app
