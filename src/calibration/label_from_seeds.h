#pragma once

#include <vector>

#include "calibration/grow_labels.h"
#include "stereomotion/calibration/find_control_points.h"

namespace stereomotion {

/// Holds a labelling together with the seeds that contradict it.
struct SeedLabelling {
  Labelling labelling;
  std::vector<int> contradicting;  ///< points whose seed lies elsewhere
};

/// Labels blobs by rough seeds.
///
/// Every few seeds, each with one of the blobs near it, propose a camera; those whose blobs fit it
/// grow labels outwards, and the camera that explains most blobs wins. So a seed that is wrong, or
/// nearer to a neighbour's ball, does no harm. Points of the target are to be given as surveyed;
/// a left-handed survey is recognised.
Expected<SeedLabelling, LabelProblem> LabelFromSeeds(const Target& target,
                                                     const std::vector<Eigen::Vector2d>& blobs_px,
                                                     const std::vector<Seed>& seeds, int width_px,
                                                     int height_px);

}  // namespace stereomotion
