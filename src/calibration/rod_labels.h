#pragma once

#include <Eigen/Core>
#include <vector>

#include "stereomotion/core/body.h"

namespace stereomotion {

/// Says which image point is which ball: for the body's balls, numbered rod by rod, the index of
/// the point, −1: none.
using RodLabels = std::vector<int>;

/// Lists the balls of a body rod by rod.
std::vector<BallId> ListBalls(const Body& body);

/// Finds the rods of a body in one image, whose distortion has been removed: the sets of
/// `FindCollinearBalls` that give the most rods, no point used twice. Several where rods or
/// directions look alike to within the accuracy of the points, at most eight, best first; empty
/// where no rod is whole.
std::vector<RodLabels> LabelRods(const std::vector<Eigen::Vector2d>& points_px, const Body& body);

/// Counts the rods that both label.
int CommonRods(const Body& body, const RodLabels& first, const RodLabels& second);

}  // namespace stereomotion
