#pragma once

#include <Eigen/Core>
#include <vector>

namespace stereomotion {

/// Holds points of a target that lie on one line, in order along it.
struct TargetRod {
  std::vector<int> points;           ///< indices into the points given
  std::vector<double> distances_mm;  ///< of each from the first
};

/// Finds all lines of four to nine points, within `tolerance_mm` of the line; most points first.
/// A point may lie on several lines; a line of more than nine is cut to its first nine.
std::vector<TargetRod> FindTargetRods(const std::vector<Eigen::Vector3d>& points_mm,
                                      double tolerance_mm);

}  // namespace stereomotion
