#pragma once

#include "stereomotion/calibration/adjust_bundle.h"
#include "stereomotion/calibration/refine_rig.h"
#include "stereomotion/camera/rig.h"

namespace stereomotion {

/// Compares the second camera's pose against the first of a refined rig (with covariance) and of
/// the old one. The two share the prior's errors: the refined parameters follow them with the gain
/// C_post C_prior⁻¹, whose product with the old covariance is taken out of the difference.
CameraMotion CompareRigs(const Rig& old_rig, const Rig& refined,
                         const std::optional<BundlePrior>& prior);

/// Covariance of `first_from_second` (rotation [rad], centre [mm], axes of the first camera) as a
/// rig's covariance has it; zero without one.
Matrix6d RelativeCovariance(const Rig& rig);

}  // namespace stereomotion
