#pragma once

#include <filesystem>
#include <optional>

#include "commands.h"
#include "track_inputs.h"

namespace stereomotion::app {

/// Records the first seconds of two live cameras into RUN/learn.h5, while a person moves the bodies
/// before them, and learns the bodies from that into `inputs.setup.bodies`, and writes them into
/// RUN. The exit code where there is no answer, or an interrupt; the reason is told.
std::optional<int> LearnBodiesLive(const std::filesystem::path& folder, const TrackOptions& options,
                                   TrackInputs& inputs, const CommonOptions& common);

}  // namespace stereomotion::app
