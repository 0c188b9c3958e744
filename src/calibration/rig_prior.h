#pragma once

#include <array>
#include <optional>
#include <vector>

#include "stereomotion/calibration/adjust_bundle.h"
#include "stereomotion/camera/rig.h"

namespace stereomotion {

/// Says what of a pair of cameras is estimated again, and what is known of it.
struct PriorPlan {
  std::vector<std::array<int, CameraModel::kNumParameters>> intrinsic_unknown;
  std::vector<bool> camera_fixed;
  std::optional<BundlePrior> prior;
};

/// Makes an earlier calibration an observation of its intrinsics and of the first camera's pose;
/// the second camera's pose is left free: what is known of the others does not depend on it (a
/// normal distribution's marginal is the block of its covariance).
///
/// Intrinsics that the covariance moves as one are tied. Zero variance keeps an intrinsic; of the
/// first camera's pose it is spelled as 1e-9 rad or 1e-6 mm, far below what images tell. A
/// covariance that is singular otherwise (rounded in a file) gets 1e-10 of each variance added:
/// that never claims more than it did. Throws std::invalid_argument for one that is none.
PriorPlan PlanPrior(const Rig& rig);

/// Finds a parameter in a covariance; −1: not there.
int PlaceOf(const RigCovariance& covariance, const RigParameter& parameter);

}  // namespace stereomotion
