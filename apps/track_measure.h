#pragma once

#include <optional>
#include <vector>

#include "commands.h"
#include "live_run.h"
#include "pose_stream.h"
#include "stereomotion/core/output_error.h"
#include "stereomotion/io/run_writer.h"
#include "track_inputs.h"
#include "track_results.h"

namespace stereomotion::app {

/// Says where the pairs of a run come from and where its poses go.
struct TrackCourse {
  const TrackInputs& inputs;
  const CommonOptions& common;
  LiveRun* live = nullptr;       ///< not started yet; null: recorded
  PoseStream* stream = nullptr;  ///< null: none
};

/// Measures into `writer` and `courses`; a full disk ends the run early and is told by the result.
std::optional<OutputError> Measure(const TrackCourse& course, RunWriter& writer,
                                   std::vector<BodyCourse>& courses, RunSummary& summary);

}  // namespace stereomotion::app
