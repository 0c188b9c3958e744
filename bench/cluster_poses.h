#pragma once

#include <Eigen/Core>
#include <vector>

#include "bench/marker_scene.h"
#include "stereomotion/motion/motion_data.h"

namespace stereomotion::bench {

/// Holds the poses of a cluster of markers whose geometry was not known before.
struct ClusterPoses {
  Eigen::Matrix3Xd shape_mm;  ///< the markers' mean shape, origin at their mean
  std::vector<Rigid3> world_from_shape;
};

/// Aligns the markers of all frames with their mean shape (generalised Procrustes without scale,
/// Gower 1975), so that no single frame's noise is the reference.
ClusterPoses AlignCluster(const MarkerSeries& markers_mm);

/// Gives the poses with their covariances for markers of noise `sigma_mm`, as a series at 100 Hz.
PoseSeries SeriesOf(const ClusterPoses& poses, double sigma_mm);

/// Gives the markers as space points of a body whose geometry is not known.
MotionData DataOf(const MarkerSeries& markers_mm, const ClusterPoses& poses, double sigma_mm);

}  // namespace stereomotion::bench
