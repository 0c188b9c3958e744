#pragma once

#include <optional>

#include "commands.h"
#include "track_inputs.h"

namespace stereomotion::app {

/// Learns the bodies of the recording into `inputs.setup.bodies` and tells what was found. The exit
/// code where there is no answer, or an interrupt; the reason is told.
std::optional<int> LearnBodiesOf(const TrackOptions& options, TrackInputs& inputs,
                                 const CommonOptions& common);

}  // namespace stereomotion::app
