#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "learn_shape.h"

namespace stereomotion {

/// Calls `take(frame, camera, body ball, observation)` for all that was seen of a group.
template <class Take>
void ForEachSeen(const LearnedShape& shape, const BallGroup& group,
                 const std::vector<LearnPair>& pairs, const Take& take) {
  for (std::size_t f = 0; f < pairs.size(); ++f) {
    if (!group.world_from_group[f]) continue;
    for (std::size_t ball = 0; ball < shape.group_balls.size(); ++ball) {
      const auto& detections =
          group.detections[f][static_cast<std::size_t>(shape.group_balls[ball])];
      for (std::size_t side = 0; side < 2; ++side) {
        if (detections[side] < 0) continue;
        take(f, side, ball, pairs[f].balls[side][static_cast<std::size_t>(detections[side])]);
      }
    }
  }
}

/// Lists all balls of a body, rod by rod.
inline std::vector<Eigen::Vector3d> BallsOf(const Body& body) {
  std::vector<Eigen::Vector3d> balls_mm;
  for (const Rod& rod : body.rods) {
    balls_mm.insert(balls_mm.end(), rod.balls_in_body_mm.begin(), rod.balls_in_body_mm.end());
  }
  return balls_mm;
}

/// Finds the rod of a ball, counted over all rods.
inline std::size_t RodOfBall(const Body& body, std::size_t ball) {
  std::size_t rod = 0;
  while (ball >= body.rods[rod].balls_in_body_mm.size()) {
    ball -= body.rods[rod++].balls_in_body_mm.size();
  }
  return rod;
}

/// Measures the balls' diameters by their outlines: the median of each rod, or of all where rods
/// differ by little.
void MeasureDiameters(const BallGroup& group, const std::vector<LearnPair>& pairs,
                      const std::array<const RigCamera*, 2>& cameras, LearnedShape& shape);

}  // namespace stereomotion
