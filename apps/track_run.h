#pragma once

#include "commands.h"
#include "track_inputs.h"

namespace stereomotion::app {

/// Measures the bodies of a recording into a RUN, then their motion. Returns the exit code; throws
/// what `main` turns into one.
int RunTrack(const TrackOptions& given, const CommonOptions& common);

}  // namespace stereomotion::app
