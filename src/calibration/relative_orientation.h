#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "stereomotion/camera/camera.h"
#include "stereomotion/geometry/rigid3.h"

namespace stereomotion {

/// Holds the images of one point in two cameras [px].
struct PixelPair {
  Eigen::Vector2d first_px;
  Eigen::Vector2d second_px;
};

/// Finds `second_from_first`, the distance of the cameras being 1, from the essential matrix
/// (Nistér 2004, RANSAC with a fixed seed; of its four poses the one with the points before both
/// cameras). Nothing for fewer than 16 pairs that agree. `most_samples`: of five pairs, that are
/// tried.
std::optional<Rigid3> FindRelativeOrientation(const CameraModel& first, const CameraModel& second,
                                              const std::vector<PixelPair>& pairs,
                                              int most_samples = 1000);

}  // namespace stereomotion
