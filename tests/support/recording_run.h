#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "stereomotion/core/run_summary.h"
#include "stereomotion/pipeline/measure.h"
#include "stereomotion/pose/pair_measurement.h"
#include "tests/support/truth.h"

namespace stereomotion::testing {

/// Holds a recording's truth and all that was measured in it.
struct RecordingRun {
  MeasureSetup setup;
  Truth truth;
  std::vector<PairMeasurement> measurements;
  RunSummary summary;
};

/// Measures a recorded folder pair (`cam0`, `cam1`, `body.yaml`) by the way that `track` takes, all
/// options at their defaults, with the noise learned unless the rig states it.
RecordingRun MeasureFolder(const std::filesystem::path& recording,
                           const std::string& rig_file = "rig.yaml");

/// Finds the recordings shared by all projects: $STEREOMOTION_SHARED_DATA, or ../shared/data beside
/// the sources.
std::filesystem::path SharedData();

/// Finds the recording that the repository carries.
std::filesystem::path DemoRecording();

}  // namespace stereomotion::testing
