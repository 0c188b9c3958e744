#pragma once

#include <array>
#include <vector>

#include "stereomotion/calibration/calibration.h"
#include "stereomotion/calibration/calibration_setup.h"
#include "stereomotion/calibration/target_observation.h"

namespace stereomotion {

/// Says which intrinsics are estimated, and which of them as one unknown.
struct IntrinsicsPlan {
  std::vector<std::array<int, CameraModel::kNumParameters>> unknown;  ///< per camera; −1: kept
  std::vector<CalibrationNote> notes;                                 ///< what was reduced, and why
};

/// Decides what the observations can carry: what `free` asks for, or fx fy cx cy k1 k2 p1 p2; of a
/// single static frame with few points less (`intrinsics_reduced`).
IntrinsicsPlan PlanIntrinsics(const CalibrationSetup& setup,
                              const std::vector<TargetObservation>& observations);

}  // namespace stereomotion
