#pragma once

#include <optional>
#include <string>
#include <vector>

#include "learn_points.h"
#include "motion/group_balls.h"
#include "stereomotion/core/body.h"
#include "stereomotion/motion/motion_data.h"

namespace stereomotion {

/// Holds a body as its group of points tells it: rods in order, with names and ball diameters.
struct LearnedShape {
  Body body;
  std::vector<int> group_balls;  ///< of every ball of the body: its place in the group
  int left_over = 0;             ///< balls of the group that are on no rod
  /// Of every frame: what the group's pose is in the body's frame.
  std::vector<std::optional<Rigid3>> world_from_body;
};

/// Makes a body of a group: its balls sorted into rods, the body frame's origin at their mean, its
/// axes as the world's in the first frame where the group was found. Rods are named A, B, … by
/// where they begin (x, then y, z); a rod begins at the end with the smaller coordinate of the axis
/// that it lies along most. `diameter_mm` 0: from the apparent sizes. Nothing without a rod.
std::optional<LearnedShape> ShapeOf(const BallGroup& group, const std::vector<LearnPair>& pairs,
                                    const RigCamera& left, const RigCamera& right,
                                    double diameter_mm);

/// Gathers what the detections of a group tell: projections of the balls' centres.
MotionData ObservationsOfShape(const LearnedShape& shape, const BallGroup& group,
                               const std::vector<LearnPair>& pairs, const MeasureSetup& setup);

}  // namespace stereomotion
