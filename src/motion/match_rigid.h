#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "stereomotion/geometry/rigid3.h"

namespace stereomotion {

/// Holds a point that may be a ball, as one frame pair gives it.
struct CloudPoint {
  Eigen::Vector3d p_mm = Eigen::Vector3d::Zero();
  double sigma_mm = 0;  ///< in the direction in which it is largest
  /// What it was made from, left and right detection; two points of one detection exclude each
  /// other. −1: nothing.
  std::array<int, 2> detections{-1, -1};
};

using PointCloud = std::vector<CloudPoint>;

struct RigidMatchOptions {
  double gate_sigma = 5;  ///< of a distance between two points
  int min_points = 4;     ///< three match by chance
  /// Stops at a motion that brings so large a share of the smaller cloud to match; the rest is
  /// hidden, or no ball.
  double enough = 0.8;
};

/// Holds a rigid motion that brings points of one cloud onto points of another.
struct RigidMatch {
  Rigid3 b_from_a;
  std::vector<std::pair<int, int>> pairs;  ///< (index in a, index in b), by index in a
};

/// Finds the rigid motion under which most points of `a` meet points of `b`, however far they went.
///
/// A rigid motion keeps distances. Three points of `a`, not on a line, whose distances three points
/// of `b` repeat tell a motion; the one that most other points follow is taken (all are tried, the
/// widest pairs first, so the result is the same each time). Nothing where no motion carries
/// `min_points` points, not all on a line.
std::optional<RigidMatch> MatchRigid(const PointCloud& a, const PointCloud& b,
                                     const RigidMatchOptions& options = {});

/// Pairs the points that meet under a given motion, one to one, nearest first, and fits the motion
/// to them; nothing where they are fewer than `min_points` or on a line. `widening` ≥ 1: of the
/// gate at first, for a motion that is only rough.
std::optional<RigidMatch> PairUnder(const Rigid3& b_from_a, const PointCloud& a,
                                    const PointCloud& b, double widening,
                                    const RigidMatchOptions& options);

}  // namespace stereomotion
