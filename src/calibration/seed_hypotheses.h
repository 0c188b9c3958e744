#pragma once

#include <Eigen/Core>
#include <vector>

#include "calibration/label_camera.h"

namespace stereomotion {

/// How far the image of a point may lie from its seed: ± 15 px in both coordinates, and a little.
constexpr double kSeedReach_px = 22;

/// Holds a seed with the blobs that it may mean, nearest first.
struct SeedCandidates {
  Eigen::Vector3d p_mm;
  Eigen::Vector2d pixel_px;
  std::vector<Eigen::Vector2d> blobs_px;
};

/// Holds a camera that a few seeds propose.
struct SeedHypothesis {
  LabelCamera camera;
  double misfit_px = 0;  ///< RMS distance of the chosen blobs from their predictions
};

/// Proposes cameras from subsets of `subset_size` seeds (all of them for up to nine seeds, else an
/// even choice), with each of the `max_blobs` nearest blobs of each seed. Best fit first.
std::vector<SeedHypothesis> ProposeCameras(const std::vector<SeedCandidates>& seeds,
                                           int subset_size, int max_blobs, int width_px,
                                           int height_px);

}  // namespace stereomotion
