#pragma once

#include <Eigen/Core>
#include <vector>

namespace stereomotion {

/// Tells whether points lie in a plane, or on a line: whether their thickness (RMS distance from
/// the best plane) is less than a thousandth of their extent, which no rough seed could resolve.
bool AreFlat(const std::vector<Eigen::Vector3d>& points_mm);

}  // namespace stereomotion
