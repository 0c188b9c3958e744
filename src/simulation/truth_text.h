#pragma once

#include <string>

#include "stereomotion/simulation/scenario.h"

namespace stereomotion {

/// Writes out the recording's timestamps.csv of camera `camera`.
std::string TimestampsCsv(const Scenario& scenario, int camera);

/// Writes out truth/poses.csv: `world_from_body` and the motion at the left camera's mid-exposures.
std::string TruePosesCsv(const Scenario& scenario);

/// Writes out truth/balls.csv: every ball in both images, at each camera's own mid-exposures.
std::string TrueBallsCsv(const Scenario& scenario);

/// Writes out truth/scene.json.
std::string SceneJson(const Scenario& scenario);

}  // namespace stereomotion
