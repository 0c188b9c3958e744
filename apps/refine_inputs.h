#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "refine_run.h"
#include "stereomotion/calibration/refine_rig.h"
#include "stereomotion/camera/rig.h"
#include "stereomotion/core/body.h"

namespace stereomotion::app {

/// All that a refinement takes from a finished run.
struct RefineInputs {
  Rig rig;  ///< the two cameras of the run, in the rig's order
  std::filesystem::path rig_file;
  Body body;
  std::vector<RefineFrame> frames;
  std::vector<std::string> notes;  ///< for a person: files that have changed, cameras left out
};

/// Reads run.json, detections.csv, the rig and the body. Throws `UserError` for what is missing or
/// cannot be meant.
RefineInputs LoadRefineInputs(const RefineOptionsOfRun& options);

}  // namespace stereomotion::app
