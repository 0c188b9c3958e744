#pragma once

#include <Eigen/Core>
#include <vector>

#include "motion/observed_frame.h"

namespace stereomotion {

/// Holds frames whose points were replaced by the pose that they give.
struct CondensedFrames {
  std::vector<ObservedFrame> frames;  ///< poses with their whitener, no points
  double chi2 = 0;                    ///< of all points against the frames' own poses
  int dof = 0;
  std::vector<std::size_t> kept;  ///< which of the given frames they are
};

/// Estimates every frame's own pose from its points (Gauss–Newton from the pose given) and keeps
/// its information: to second order all that the frame says about its pose. Frames whose points do
/// not determine a pose are left out; but a turn about a line that holds all points is open only.
CondensedFrames Condense(const std::vector<ObservedFrame>& frames,
                         const std::vector<Eigen::Vector3d>& balls_in_body_mm);

}  // namespace stereomotion
