#pragma once

#include <Eigen/Core>
#include <vector>

#include "bench/marker_scene.h"
#include "stereomotion/geometry/rigid3.h"

namespace stereomotion::bench {

/// Holds a line in the world.
struct AxisLine {
  Eigen::Vector3d direction;
  Eigen::Vector3d point_mm;
};

/// Symmetrical axis of rotation approach (Ehrig et al. 2007) with the second segment at rest: the
/// direction in which R_t c + t_t = p leaves (c, p) open, and the shortest solution across it.
AxisLine Sara(const std::vector<Rigid3>& world_from_body);

/// Mean helical axis (Woltring 1990): the finite helical axes of all pairs of frames, each with the
/// weight sin²(θ/2).
AxisLine MeanHelicalAxis(const std::vector<Rigid3>& world_from_body);

/// Fits circles about one axis to the markers, one plane and one radius a marker, by the distances
/// from them: least squares by Levenberg–Marquardt (Ehrig 2007, "geometric axis fit").
AxisLine FitCircles(const MarkerSeries& markers_mm, const AxisLine& start);

}  // namespace stereomotion::bench
