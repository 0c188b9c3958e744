#pragma once

#include "stereomotion/core/run_summary.h"
#include "stereomotion/pipeline/measure.h"

namespace stereomotion {

/// Settles both cameras' noise models before the run: from the rig file where it gives them, else
/// learned from each camera's first readable images and frozen, else a default with a warning.
void LearnNoise(const PairSource& source, const MeasureSetup& setup, const MeasureOptions& options,
                std::int64_t end, RunSummary& summary);

}  // namespace stereomotion
