#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "stereomotion/core/expected.h"
#include "stereomotion/motion/motion_data.h"

namespace stereomotion {

/// Holds the measured places of markers that sit on one rigid body.
struct MarkerSeries {
  double rate_hz = 0;
  int first_frame = 0;
  /// frames × markers, mm, in the world; NaN: not seen.
  std::vector<std::vector<Eigen::Vector3d>> points_mm;
};

/// Says why markers give no motion.
enum class ClusterFailure {
  kTooFewMarkers,  ///< fewer than three, or all on one line
  kTooFewFrames,   ///< fewer than two frames show three of them
};

/// Holds a cluster of markers as data for the analysis of motion.
struct MarkerCluster {
  MotionData data;      ///< space points of unknown structure, and the poses of the rigid fit
  double sigma_mm = 0;  ///< of a coordinate: as given, or estimated
  double rms_mm = 0;    ///< of the distances from the rigid body
  int not_rigid = 0;    ///< frames left out: they fit the body five times worse than most
};

/// Makes a rigid body of markers: mean shape and poses by alternate alignment (generalised
/// Procrustes, Gower 1975), origin in the markers' mean, axes as the world's in the first frame
/// with a pose. `sigma_mm` is a coordinate's standard uncertainty; 0: from the residuals of the
/// rigid fit, all degrees of freedom counted. Throws std::invalid_argument: rate not positive,
/// frames of different numbers of markers.
Expected<MarkerCluster, ClusterFailure> MakeCluster(const MarkerSeries& markers,
                                                    double sigma_mm = 0);

}  // namespace stereomotion
