#pragma once

#include <Eigen/Core>
#include <vector>

namespace stereomotion {

struct RodSortOptions {
  std::size_t usual = 5;        ///< balls a rod, of the design
  double straightness = 0.005;  ///< a ball lies off its rod's line by at most this share of it
  double slack_mm = 0;          ///< and this much for the noise
};

/// Holds balls on a line.
struct ThreadedLine {
  std::vector<int> balls;  ///< in order along it
  double bend = 0;         ///< largest distance off it, in units of what is allowed
};

/// Lists the lines between any two balls that hold one more at least, and all that lie between.
std::vector<ThreadedLine> LinesThrough(const std::vector<Eigen::Vector3d>& balls_mm,
                                       const RodSortOptions& options);

/// Holds balls sorted into rods; every ball stands in one rod or is left over.
struct SortedRods {
  std::vector<std::vector<int>> rods;  ///< in the order in which they are threaded
  std::vector<int> left_over;
};

/// Sorts balls into rods: sets of 3 to 9 on a line. Of all ways, the one that leaves the fewest
/// balls over, then has the fewest rods, then the most of the usual number, then the straightest.
SortedRods SortIntoRods(const std::vector<Eigen::Vector3d>& balls_mm,
                        const RodSortOptions& options = {});

}  // namespace stereomotion
