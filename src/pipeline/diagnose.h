#pragma once

#include <optional>
#include <string>
#include <vector>

#include "stereomotion/detection/ball_observation.h"
#include "stereomotion/pipeline/measure.h"

namespace stereomotion {

/// Holds the detections of a pair that gave no pose.
struct FailedPair {
  std::vector<BallObservation> left;
  std::vector<BallObservation> right;
};

/// Looks for the reason why no pair of a run gave a pose of `body`: nothing detected, cameras
/// swapped, wrong units in the body file, a rig that does not fit. One sentence for a person, with
/// what to do.
std::string DiagnoseFailure(const MeasureSetup& setup, const Body& body,
                            const MeasureOptions& options, const std::vector<FailedPair>& pairs);

}  // namespace stereomotion
