#pragma once

#include <string>
#include <vector>

#include "stereomotion/calibration/adjust_bundle.h"
#include "stereomotion/calibration/calibration.h"
#include "stereomotion/calibration/calibration_setup.h"
#include "stereomotion/calibration/target_observation.h"
#include "stereomotion/core/expected.h"

namespace stereomotion {

// First values for the bundle adjustment, one function a kind of target. Each takes the plan of
// what is estimated and returns the problem with all cameras, views and observations placed, or
// the note that says why there is no start.

using BundleStart = Expected<BundleProblem, CalibrationNote>;

/// Static frame of surveyed points: normalised DLT or, with few points, a search over focal
/// lengths; the better one. The world is the target's.
BundleStart StartControlPoints(const CalibrationSetup& setup, const BundleProblem& plan);

/// Boards: each camera by itself (Zhang 2000), then the cameras among each other from views that
/// they share. The world is the board in the first view that was seen.
BundleStart StartBoards(const CalibrationSetup& setup, const BundleProblem& plan);

/// Wand: relative orientation from the essential matrix, scale from the known distances, over
/// several focal lengths. The world is the first camera, or the surveyed world points.
BundleStart StartWand(const CalibrationSetup& setup, const BundleProblem& plan);

/// Lays out the problem without start values of poses: cameras with their known or guessed
/// intrinsics (f = 1.2 × width, principal point in the middle), points, views, observations.
/// `intrinsic_unknown` is what `PlanIntrinsics` decided.
BundleProblem LayOutBundle(const CalibrationSetup& setup,
                           const std::vector<TargetObservation>& observations,
                           const std::vector<std::array<int, 9>>& intrinsic_unknown);

/// Picks the observations of one camera (−1: all) and view (−1: all).
std::vector<BundleObservation> ObservationsOf(const BundleProblem& problem, int camera, int view);

/// Numbers the unknown intrinsics from 0 again after some were taken out.
void NumberWithoutGaps(BundleProblem& problem);

/// Makes the problem of one camera alone, its observations as camera 0.
BundleProblem SingleCamera(const BundleProblem& problem, int camera);

}  // namespace stereomotion
