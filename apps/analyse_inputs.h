#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analyse_options.h"
#include "stereomotion/motion/analyse_motion.h"

namespace stereomotion::app {

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
  std::string no_answer;  ///< why the markers give no motion; empty: they may
};

/// Reads RUN (with one or several bodies), poses or markers. Throws `UserError`.
AnalyseInputs LoadAnalyseInputs(const AnalyseArguments& arguments, const AnalyseOptions& options);

}  // namespace stereomotion::app
