#pragma once

#include <random>

#include "stereomotion/camera/rig.h"

namespace stereomotion::testing {

/// States a covariance for all parameters of a rig's cameras, as from a good calibration; poses are
/// correlated between the cameras, which share a world.
RigCovariance GoodCalibration(const Rig& rig);

/// Changes one parameter of a camera (`RigParameter::index`).
void ChangeParameter(RigCamera& camera, int index, double delta);

/// Draws a rig from a rig's covariance about it.
Rig DrawRig(const Rig& rig, std::mt19937_64& rng);

}  // namespace stereomotion::testing
