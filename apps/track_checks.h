#pragma once

#include <string>
#include <vector>

#include "track_inputs.h"

namespace stereomotion::app {

/// Says where --exposure-ms is not used, since the recording tells; nothing where it is used for
/// every frame.
std::vector<std::string> ExposureWarnings(const RecordingReport& report, double exposure_ms);

/// Says which masks cover much of an image, or nothing at all. `name`: of the file, or what the
/// mask is called.
std::vector<std::string> MaskWarnings(const MeasureSetup& setup, const std::string& name);

/// Refuses bodies that look alike (`FindConfusion`), with the swap margin: throws `UserError`.
/// Warns of those that only parts of their rods tell apart.
std::vector<std::string> CheckBodiesDiffer(const std::vector<Body>& bodies);

/// Refuses a target of --learn-mask that exists (without --force), is read as an input or lies
/// among the images, or cannot be written; before hours of measuring.
void CheckMaskTarget(const TrackOptions& options, const TrackInputs& inputs);

}  // namespace stereomotion::app
