#pragma once

#include <filesystem>
#include <vector>

#include "stereomotion/simulation/scenario.h"

namespace stereomotion {

/// Holds a scenario with the files that it was read from.
struct ScenarioFile {
  Scenario scenario;
  std::filesystem::path rig;  ///< its path in the scenario file is relative to that file
  std::filesystem::path body;
};

/// Reads a `stereomotion-scenario/1` file with the rig and the body that it names
/// (calib/scenario.yaml is the commented example).
///
/// Throws `UserError` with file, line and key, what was found and what was expected; also where the
/// law of motion is given a key that it does not have (a pitch for a fixed centre).
ScenarioFile ReadScenario(const std::filesystem::path& file);

}  // namespace stereomotion
