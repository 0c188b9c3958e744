#pragma once

#include <string_view>

#include "stereomotion/detection/ball_observation.h"
#include "stereomotion/pose/pair_measurement.h"
#include "stereomotion/pose/pose_estimate.h"

namespace stereomotion {

/// Spell a status as the CSV files do (docs/formats.md lists the words with their meaning).
std::string_view StatusWord(PoseStatus status);
std::string_view StatusWord(BallStatus status);
std::string_view StatusWord(BlobStatus status);

}  // namespace stereomotion
