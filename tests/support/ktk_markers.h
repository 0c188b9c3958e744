#pragma once

#include <string>
#include <vector>

#include "stereomotion/io/c3d_file.h"
#include "stereomotion/motion/marker_cluster.h"

namespace stereomotion::testing {

/// Reads a recording of real/clusters_ktk (Kinetics Toolkit), C3D or N3D.
C3dPoints ReadKtk(const std::string& file_name);

/// Picks markers by their labels, all frames.
MarkerSeries PickMarkers(const C3dPoints& points, const std::vector<std::string>& labels);

}  // namespace stereomotion::testing
