#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "stereomotion/motion/motion_data.h"

namespace stereomotion {

/// Reads poses.csv of a RUN, or any CSV with its columns: `timestamp_ns`, `qw … tz_mm` are needed,
/// the others may lack (a missing `status` means ok, missing covariances: see docs/formats.md).
/// Throws `UserError` with file and line.
PoseSeries ReadPosesCsv(const std::filesystem::path& file);

/// Reads what a RUN (or RUN/<body>) holds for the analysis of motion, without images: poses.csv,
/// balls.csv, rig.yaml, body.yaml. Throws `UserError`.
MotionData ReadMotionData(const std::filesystem::path& run);

}  // namespace stereomotion
