#pragma once

#include <Eigen/Core>
#include <vector>

#include "stereomotion/core/expected.h"
#include "stereomotion/motion/motion_data.h"

namespace stereomotion {

enum class StructureFailure {
  kTooFewBalls,  ///< fewer than three, or one seen in too few frames
  kNoConvergence,
};

struct StructureOptions {
  /// Observations whose residual is longer than this (in σ × robust scale of all residuals, 1 or
  /// more) are left out. Two coordinates exceed 5 σ by noise once in 300 000.
  double reject_sigma = 5;
};

/// Holds a body's geometry as learned together with its motion.
struct Structure {
  std::vector<Eigen::Vector3d> balls_in_body_mm;
  /// Random covariance (3M×3M) in the stated gauge: origin at the balls' mean, axes fixed by no net
  /// rotation of the balls against the start values (rank 3M − 6; of a straight rod M − 1).
  Eigen::MatrixXd covariance_mm2;
  /// Common part, from the rig's covariance; empty: the rig has none.
  Eigen::MatrixXd calibration_covariance_mm2;
  std::vector<Rigid3> poses;      ///< of every frame of the data, as refined
  std::vector<int> observations;  ///< of every ball: image or space points used
  int rejected = 0;               ///< observations left out as gross errors
  double chi2 = 0;
  int dof = 0;
};

/// Refines a body's geometry and all poses together on what was observed (image or space points).
///
/// Maximum likelihood: Ceres minimises the whitened residuals, at first under a robust loss
/// (Cauchy), then, without the observations that contradict the others, as plain least squares. The
/// scale is the rig's; the origin and the axes are free and are fixed afterwards by two
/// constraints: Σ xᵢ = 0 and Σ x⁰ᵢ × xᵢ = 0 (x⁰: start values less their mean). The covariance is
/// that of the undamped least squares on the constraints, the poses eliminated by orthogonal
/// transformations (square-root form of the Schur complement). Balls that start on one line are a
/// straight rod: they stay on it, its direction in the body and the open roll of the poses stay as
/// they are. Poses start from the data; frames
/// without one, or whose points leave it open, take no part. Throws std::invalid_argument for data
/// that breaks its own rules.
Expected<Structure, StructureFailure> RefineStructure(const MotionData& data,
                                                      const StructureOptions& options = {});

}  // namespace stereomotion
