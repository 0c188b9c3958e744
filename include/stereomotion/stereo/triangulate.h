#pragma once

#include <Eigen/Core>

#include "stereomotion/camera/rig.h"
#include "stereomotion/core/expected.h"

namespace stereomotion {

/// Says why two image points give no 3D point (words: docs/formats.md).
enum class TriangulationFailure {
  kRaysNearlyParallel,  ///< depth is not determined
  kBehindCamera,
  kNoConvergence,
  kInconsistent,  ///< the rays miss each other beyond the gate
};

/// Holds the projections of ONE ball's centre in two cameras, with random covariances.
struct PointPair {
  Eigen::Vector2d left_px, right_px;
  Eigen::Matrix2d left_cov_px2, right_cov_px2;
};

/// Holds a triangulated point in world coordinates.
struct TriangulatedPoint {
  Eigen::Vector3d p_in_world_mm;
  Eigen::Matrix3d covariance_mm2;  ///< random part: (JᵀWJ)⁻¹ of the whitened reprojection error
  double chi2 = 0;                 ///< of 4 observations − 3 unknowns = 1 degree of freedom
  /// ∂ point / ∂ (left camera's 15 parameters, right camera's 15 parameters); see `RigParameter`.
  Eigen::Matrix<double, 3, 2 * RigParameter::kPerCamera> d_rig;
};

struct TriangulateOptions {
  double min_ray_angle_rad = 0.0035;  ///< 0.2°: below it, depth is guessed, not measured
  double max_chi2 = 1e300;            ///< gate on consistency; off by default
};

/// Finds the world point whose projections fit both image points best: whitened reprojection error,
/// Gauss–Newton from the rays' midpoint (Hartley & Sturm 1997 for the criterion).
Expected<TriangulatedPoint, TriangulationFailure> Triangulate(
    const RigCamera& left, const RigCamera& right, const PointPair& points,
    const TriangulateOptions& options = {});

}  // namespace stereomotion
