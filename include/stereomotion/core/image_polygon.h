#pragma once

#include <Eigen/Core>
#include <vector>

#include "stereomotion/core/image_mask.h"

namespace stereomotion {

/// Lists the corners of a polygon in an image [px], in order; the last is joined to the first.
using ImagePolygon = std::vector<Eigen::Vector2d>;

/// Marks the pixels whose centres lie in a polygon or on its edge (even-odd rule where it crosses
/// itself); what lies outside the mask's image is left out. Throws std::invalid_argument for fewer
/// than three corners and for one that is not finite.
void MarkPolygon(const ImagePolygon& polygon, ImageMask& mask);

/// Finds the smallest convex polygon around points (Andrew's monotone chain, 1979), without corners
/// on its edges. Fewer than three come back for points on one line.
ImagePolygon ConvexHull(std::vector<Eigen::Vector2d> points);

}  // namespace stereomotion
