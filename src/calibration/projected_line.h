#pragma once

#include <Eigen/Core>
#include <vector>

namespace stereomotion {

/// Fits the image of a straight line, (A + B x) / (1 + k x), to ≥ 3 points at the places `share`
/// (0 … 1) along it, with least squares; returns the RMS distance of the points, infinity where no
/// such line exists (k ≤ −1: it would pass behind the camera).
double MisfitOfProjectedLine(const std::vector<Eigen::Vector2d>& pixels_px,
                             const std::vector<double>& share);

}  // namespace stereomotion
