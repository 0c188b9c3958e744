#pragma once

#include <filesystem>

#include "track_inputs.h"

namespace stereomotion::app {

/// Refuses a --record that cannot be meant or that exists (without --force), before anything is
/// opened or learned; changes nothing. Throws `UserError`.
void CheckRecordTarget(const TrackOptions& options, const std::filesystem::path& run);

/// Tries whether --stream can be opened and closes it again: before the bodies are learned, whose
/// names the stream begins with. Throws `UserError`, `OutputError`.
void TryStream(const TrackOptions& options);

}  // namespace stereomotion::app
