#pragma once

#include "commands.h"
#include "track_inputs.h"

namespace stereomotion::app {

/// Runs `track --learn-mask`: writes a mask of what stays bright in the recording; returns the exit
/// code.
int RunLearnMask(const TrackOptions& options, const TrackInputs& inputs,
                 const CommonOptions& common);

}  // namespace stereomotion::app
