#pragma once

#include <Eigen/Core>
#include <vector>

namespace stereomotion {

/// Holds image points that lie like the balls of one rod or wand.
struct CollinearBalls {
  std::vector<int> points;  ///< per ball of the rod: index into the image points
  double misfit_px = 0;     ///< RMS distance from the best line with the rod's projective spacing
};

struct CollinearOptions {
  double tolerance_px = 2;  ///< of the projective fit; rods of three: of the line
  /// Rods of two or three: nothing projective tells their spacing; how far the ratio of the
  /// distances in the image may be from the rod's own, relative (perspective along the rod).
  double max_ratio_error = 0.25;
};

/// Finds sets of image points that lie on a line with the projected spacing of a straight rod whose
/// balls stand at `distances_mm` (ascending, 2 to 9 of them); all balls of the rod must be there.
/// Four balls and more are told by their cross-ratios, which no pose changes; a rod is tried in
/// both directions. Best first. A symmetrical rod appears in both directions, and so does every rod
/// of four: its one cross-ratio is the same reversed. Throws std::invalid_argument for distances
/// that do not ascend and for tolerances that are not positive.
std::vector<CollinearBalls> FindCollinearBalls(const std::vector<Eigen::Vector2d>& points_px,
                                               const std::vector<double>& distances_mm,
                                               const CollinearOptions& options = {});

}  // namespace stereomotion
