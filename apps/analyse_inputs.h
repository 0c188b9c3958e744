#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "stereomotion/motion/analyse_motion.h"

namespace stereomotion::app {

/// What the user asked of `analyse`.
struct AnalyseArguments {
  std::string input;  ///< RUN, CSV file of poses, or C3D/N3D file of markers
  std::string law;
  double path_psd_mm2_s3 = 0;  ///< 0: none
  std::string filter;          ///< empty: none
  double cutoff_hz = 6;
  int order = 4;
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

/// Holds one body that is analysed, and where its files go.
struct AnalyseBody {
  std::string name;
  std::filesystem::path folder;
  MotionData data;
};

/// Holds all that is read before the analysis starts.
struct AnalyseInputs {
  bool is_run = false;
  std::filesystem::path folder;  ///< for what concerns all bodies
  std::vector<AnalyseBody> bodies;
  std::vector<std::string> warnings;
};

/// Reads RUN (with one or several bodies), poses or markers. Throws `UserError`.
AnalyseInputs LoadAnalyseInputs(const AnalyseArguments& arguments, const AnalyseOptions& options);

}  // namespace stereomotion::app
