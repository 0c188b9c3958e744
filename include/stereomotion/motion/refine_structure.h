#pragma once

#include <Eigen/Core>

#include "stereomotion/core/expected.h"
#include "stereomotion/motion/motion_data.h"

namespace stereomotion {

enum class StructureFailure {
  kTooFewBalls,  ///< fewer than three, or seen in too few frames
  kNoConvergence,
};

/// Holds a body's geometry as learned together with its motion.
struct Structure {
  std::vector<Eigen::Vector3d> balls_in_body_mm;
  /// Random covariance (3M×3M) in the stated gauge: origin at the balls' mean, axes fixed by no net
  /// rotation of the balls against the start values (rank 3M − 6).
  Eigen::MatrixXd covariance_mm2;
  /// Common part, from the rig's covariance; empty: the rig has none.
  Eigen::MatrixXd calibration_covariance_mm2;
  std::vector<Rigid3> poses;  ///< of every frame of the data, as refined
  double chi2 = 0;
  int dof = 0;
};

/// Refines a body's geometry and all poses together on what was observed (Ceres; image or space
/// points), robust against outliers.
Expected<Structure, StructureFailure> RefineStructure(const MotionData& data);

}  // namespace stereomotion
