#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "stereomotion/core/body.h"
#include "stereomotion/geometry/rigid3.h"
#include "stereomotion/pose/pose_estimate.h"

namespace stereomotion {

/// Finds the ball's centre in the body frame [mm].
inline const Eigen::Vector3d& BallInBody(const Body& body, const BallId& id) {
  return body.rods[static_cast<std::size_t>(id.rod)]
      .balls_in_body_mm[static_cast<std::size_t>(id.ball)];
}

inline double BallRadius(const Body& body, const BallId& id) {
  return body.rods[static_cast<std::size_t>(id.rod)].ball_diameter_mm / 2;
}

/// Lists all balls of the body, rod by rod.
std::vector<BallId> AllBalls(const Body& body);

/// Throws std::invalid_argument unless every rod has balls and every ball a size.
void CheckBody(const Body& body);

/// Finds the direction of the line on which all points lie, first to last; nothing where they do
/// not. A line is bent by at most 0.1 % of its length or `sigma_mm` × 3: such a bend would
/// "determine" the roll to degrees at best.
std::optional<Eigen::Vector3d> CommonLine(const std::vector<Eigen::Vector3d>& points_mm,
                                          double sigma_mm);

/// As `CommonLine`, of all balls of the body.
std::optional<Eigen::Vector3d> BodyLine(const Body& body);

/// Turns `from` by the smallest rotation that brings `axis_in_body` onto `axis_in_world`.
Eigen::Quaterniond SmallestRotation(const Eigen::Quaterniond& from,
                                    const Eigen::Vector3d& axis_in_body,
                                    const Eigen::Vector3d& axis_in_world);

/// Chooses a free roll closest to `previous`; does nothing where the roll is determined.
void SetFreeRoll(const Body& body, const Rigid3& previous, PoseEstimate& pose);

/// Propagates the pose's random covariance to the place of one ball: σ, all directions together
/// [mm].
double BallSigmaMm(const Body& body, const PoseEstimate& pose, const BallId& id);

/// Finds the largest way that a ball goes between two placements of the body [mm].
double LargestBallShift(const Body& body, const Rigid3& a_world_from_body,
                        const Rigid3& b_world_from_body);

}  // namespace stereomotion
