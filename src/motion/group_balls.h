#pragma once

#include <array>
#include <optional>
#include <vector>

#include "motion/match_rigid.h"

namespace stereomotion {

struct GroupOptions {
  RigidMatchOptions match;
  int seed_frames = 6;      ///< spread over the recording; motions between them start the groups
  double min_share = 0.15;  ///< of the frames in which a group is found, that must show a ball
  int min_frames = 3;       ///< in which a group, and every ball of it, must be found
  int max_groups = 8;
};

/// Holds points that keep their mutual distances.
struct BallGroup {
  /// In the group's own frame: that of the world at one of the frames.
  PointCloud balls;
  std::vector<std::optional<Rigid3>> world_from_group;  ///< a frame
  /// A frame, a ball: the detections of its point; {−1, −1}: not seen.
  std::vector<std::vector<std::array<int, 2>>> detections;
  double travel_mm = 0;  ///< longest way of a ball from where it was first
  bool moves = false;    ///< farther than the noise would have it

  [[nodiscard]] int CountFrames() const;
};

/// Finds the groups of points that move as one rigid body each, largest first.
///
/// Rigid motions between some of the frames (`MatchRigid`) start a group. It is then found in every
/// frame by its distances alone, so neither the way between two frames nor a gap matters; its
/// points are averaged, points that show up at the same place of it again and again become balls of
/// it, and those that seldom do, or only while the group rested, are dropped. The points of a
/// group, and what shares a detection with them, are then taken out, and the next is sought. What
/// stands still is a group too.
std::vector<BallGroup> GroupBalls(const std::vector<PointCloud>& frames,
                                  const GroupOptions& options = {});

}  // namespace stereomotion
