#pragma once

#include <string>

#include "commands.h"

namespace stereomotion::app {

/// What the user asked of `calibrate --refine`.
struct RefineOptionsOfRun {
  std::string run;     ///< folder of a finished run
  std::string output;  ///< the refined rig
  std::string rig;     ///< instead of the rig that the run names; may be empty
  std::string body;    ///< likewise
  std::string date;    ///< for the rig's record, ISO 8601; may be empty
  bool force = false;  ///< overwrite `output`
};

/// Re-levels the rig of a run from its rods, prints what changed and writes the refined rig.
/// Returns the exit code. Throws `UserError` for files that cannot be meant.
int RefineRun(const RefineOptionsOfRun& options, const CommonOptions& common);

}  // namespace stereomotion::app
