#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analyse_inputs.h"
#include "analyse_options.h"
#include "motion_run.h"
#include "stereomotion/io/write_file.h"

namespace stereomotion::app {

/// Adds filtered.csv of a body to `files`. Returns the filter with all its numbers; throws
/// `UserError` where it cannot filter this series.
std::string AddFiltered(const AnalyseArguments& arguments, const std::filesystem::path& folder,
                        const MotionAnalysis& analysis, std::vector<TextFile>& files);

/// Adds what --relative-to and --angles ask for, into each body's folder: relative.csv,
/// angles.csv. Throws `UserError`.
void AddRelative(const AnalyseArguments& arguments, const AnalyseInputs& inputs,
                 const std::vector<BodyMotion>& bodies, std::vector<TextFile>& files);

/// Adds joint_angles.csv of two bodies by the convention of --joint; the base (proximal) body is
/// the one of --relative-to, else the first.
void AddJointAngles(const AnalyseArguments& arguments, const std::filesystem::path& folder,
                    const std::vector<BodyMotion>& bodies, std::vector<TextFile>& files);

/// Lists the optional results of an earlier analysis in the same folders that `files` do not
/// replace: beside the new motion they would be wrong. The input is never among them.
std::vector<std::filesystem::path> StaleResults(const AnalyseArguments& arguments,
                                                const AnalyseInputs& inputs,
                                                const std::vector<TextFile>& files);

}  // namespace stereomotion::app
