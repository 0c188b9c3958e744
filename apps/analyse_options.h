#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "stereomotion/motion/analyse_motion.h"
#include "stereomotion/motion/filter.h"

namespace stereomotion::app {

/// What the user asked of `analyse`.
struct AnalyseArguments {
  std::string input;  ///< RUN, CSV file of poses, or C3D/N3D file of markers
  std::string law;
  double path_psd_mm2_s3 = 0;  ///< 0: none
  std::string filter;          ///< empty: none
  double cutoff_hz = 6;
  int order = 4;
  bool butterworth_told = false;  ///< one of these two was given
  double max_gap_s = 0.1;
  std::string relative_to;  ///< frame number or body; empty: the world
  std::string angles;       ///< sequence; empty: none
  std::string joint;        ///< convention; empty: none
  std::string side = "right";
  std::vector<std::string> points;  ///< a cluster each: labels or patterns with *, comma separated
  double point_sigma_mm = 0;        ///< 0: from the rigid fit
  double pose_sigma_deg = 0, pose_sigma_mm = 0;  ///< 0: as the file tells, or estimated
  std::string output;
  bool force = false;
};

/// Adds the options of `analyse` and its examples to the command.
void AddAnalyseOptions(CLI::App& analyse, AnalyseArguments& arguments);

/// Checks what the command line alone tells, and makes the options of the analysis. Throws
/// `UserError`.
AnalyseOptions MakeAnalyseOptions(const AnalyseArguments& arguments);

/// Makes the options of the filter that was asked for.
FilterOptions MakeFilterOptions(const AnalyseArguments& arguments);

}  // namespace stereomotion::app
