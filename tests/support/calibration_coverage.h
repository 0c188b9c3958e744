#pragma once

#include "tests/support/recording_run.h"

namespace stereomotion::testing {

/// Largest |error| / u of any component in a run, u² = `ucal²` + the random variance.
struct CalibrationCoverage {
  double worst_pose = 0, worst_ball = 0;
};

/// Compares a run that was measured with a calibrated rig with its truth. The rig's error is ONE
/// draw for the whole recording: the frames repeat one test of six components, so that 4 σ is the
/// bar, not a χ² over the frames. Infinite where a pose lacks or states no calibration uncertainty.
CalibrationCoverage CoverTruth(const RecordingRun& run);

}  // namespace stereomotion::testing
