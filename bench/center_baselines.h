#pragma once

#include <Eigen/Core>
#include <vector>

#include "bench/marker_scene.h"
#include "stereomotion/geometry/rigid3.h"

namespace stereomotion::bench {

/// Fits spheres with one centre, one radius a marker, by algebraic least squares: linear, and
/// drawn towards the markers (Gamage & Lasenby 2002).
Eigen::Vector3d FitSpheresAlgebraic(const MarkerSeries& markers_mm);

/// The same with the bias subtracted that the noise causes, which is estimated from the residuals
/// and the subtraction repeated (Halvorsen 2003).
Eigen::Vector3d FitSpheresBiasCorrected(const MarkerSeries& markers_mm);

/// Fits the same spheres by the distances from their surfaces: least squares by
/// Levenberg–Marquardt from `start_mm` (Halvorsen et al. 1999; Ehrig 2006, "geometric").
Eigen::Vector3d FitSpheresGeometric(const MarkerSeries& markers_mm,
                                    const Eigen::Vector3d& start_mm);

/// Finds the world point p that a body point c stays at: R_t c + t_t = p by linear least squares
/// (centre transformation technique; pivot calibration).
Eigen::Vector3d PivotLeastSquares(const std::vector<Rigid3>& world_from_body);

/// Finds the two body points that stay together, R_t c + t_t = S_t d + s_t, by linear least squares
/// (SCoRE, Ehrig 2006); gives d, the centre in the second body.
Eigen::Vector3d Score(const std::vector<Rigid3>& world_from_first,
                      const std::vector<Rigid3>& world_from_second);

}  // namespace stereomotion::bench
