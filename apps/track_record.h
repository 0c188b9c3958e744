#pragma once

#include "commands.h"
#include "stereomotion/capture/live_report.h"
#include "stereomotion/io/run_record.h"
#include "track_inputs.h"

namespace stereomotion::app {

/// Begins a run's record: program, command, recording, and how it is measured.
RunRecord StartRecord(const TrackInputs& inputs, const TrackOptions& options,
                      const CommonOptions& common);

/// Adds the bodies that are measured, and the warnings so far.
void AddBodies(const TrackInputs& inputs, const TrackOptions& options, RunRecord& record);

/// Lists the files that were read, with their check sums: at the end of the run, when those of the
/// images are known.
void AddInputs(const TrackOptions& options, const TrackInputs& inputs, RunRecord& record);

/// Adds what live cameras delivered, at the end of the run.
void AddLive(const LiveReport& report, RunRecord& record);

}  // namespace stereomotion::app
