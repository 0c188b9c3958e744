#pragma once

#include <Eigen/Core>
#include <cmath>

#include "stereomotion/motion/velocity.h"

namespace stereomotion {

/// Tells whether a component of ω or α along a world axis is not determined: a rod's turn about
/// itself is not seen, which leaves every component open that the rod is not normal to.
inline bool IsTurnOpen(const BodyVelocity& velocity, Eigen::Index axis) {
  constexpr double kAcross = 1e-9;  // cosine to the rod
  return velocity.open_axis_in_world && std::abs((*velocity.open_axis_in_world)[axis]) > kAcross;
}

}  // namespace stereomotion
