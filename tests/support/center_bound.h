#pragma once

#include <Eigen/Core>
#include <functional>

#include "stereomotion/camera/rig.h"
#include "stereomotion/core/body.h"
#include "stereomotion/geometry/rigid3.h"
#include "stereomotion/simulation/scenario.h"

namespace stereomotion::testing {

/// Computes the Cramér–Rao bound [px²] on each axis of a round ball's centre under a scenario's
/// light and noise, from differences of rendered images and nothing of the detector.
///
/// Unknowns: u, v, diameter, amplitude, background plane, blur (DESIGN.md); the mean over some
/// places within a pixel.
double CenterBoundPx2(const Scenario& scenario, double diameter_px);

/// Computes the Fisher information of a pose (δθ, δt) at the truth, from the outlines of all balls
/// in both cameras; `variance_px2` gives an outline's variance per axis by its diameter.
Matrix6d PoseFisher(const Scenario& scenario, const Rigid3& world_from_body,
                    const std::function<double(double diameter_px)>& variance_px2);

}  // namespace stereomotion::testing
