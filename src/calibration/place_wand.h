#pragma once

#include <map>
#include <utility>
#include <vector>

#include "stereomotion/calibration/adjust_bundle.h"
#include "stereomotion/calibration/intersect_rays.h"

namespace stereomotion {

// Places cameras and a wand whose balls are the first `num_wand_points` points of a problem; its
// intrinsics are taken as they are.

using BallSights = std::map<std::pair<int, int>, Sight>;  // (view, point) → where

/// Lists where a camera saw the wand's balls.
BallSights SightsOf(const BundleProblem& problem, int camera, int num_wand_points);

/// Places camera `c` against camera 0, and the wand where both saw two balls of it: the scale is
/// the median over all pairs of balls. False where the images give no relative orientation.
bool PlaceCamera(int c, int num_wand_points, std::vector<bool>& view_placed,
                 BundleProblem& problem);

/// Returns `plan` with the cameras of `start` and the wand placed in every view where two of its
/// balls can be triangulated; the other views' observations are not used.
BundleProblem PlaceViews(const BundleProblem& plan, const BundleProblem& start,
                         int num_wand_points);

}  // namespace stereomotion
