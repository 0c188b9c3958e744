#pragma once

#include <optional>

#include "motion/center_problem.h"
#include "stereomotion/motion/spin_center.h"

namespace stereomotion {

/// Finds the centre on a path that is merely smooth: its acceleration is white noise of the given
/// power spectral density [mm²/s³] (Wiener's velocity model; Bar-Shalom 2001, ch. 6.2), so the
/// answer holds only as far as that number does. Unknowns: position and velocity of every frame,
/// the rotations, the centre; solved by Gauss–Newton as a chain in square-root form, without
/// damping. From the frames' own poses; an unknown structure enters as refined without a law, its
/// covariance does not. The acceleration of a state has no finite variance (infinity is written).
std::optional<SpinCenter> FindOnFreePath(const CenterProblem& problem, double psd_mm2_s3);

}  // namespace stereomotion
