#pragma once

#include <array>
#include <string>

#include "tests/support/recording_run.h"
#include "tests/support/statistics.h"

namespace stereomotion::testing {

/// Holds the errors of a run against the truth.
struct RecordingScore {
  int pairs = 0;
  int poses = 0;
  int clear_pairs = 0;  ///< every rod shows at least three balls to both cameras
  int clear_poses = 0;
  int shown_centers = 0;  ///< balls that an image shows, in the pairs with a pose
  double worst_origin_mm = 0;
  double worst_centroid_mm = 0;  ///< of the body's balls
  double worst_turn_rad = 0;
  ErrorStatistics centers;  ///< projected centres, 2 components
  ErrorStatistics points;   ///< balls from two images, 3 components
  ErrorStatistics poses6;   ///< FORMATS.md's perturbation
  ErrorStatistics centroid_mm, turn_rad;
  std::array<std::array<ErrorStatistics, 2>, 2> center_axes;  ///< [camera][u, v]
};

/// Compares each measurement with the truth of its frame.
RecordingScore Score(const RecordingRun& run);

/// Spells the figures of a score as one row under `ScoreHeader`.
std::string ScoreRow(const std::string& name, const RecordingScore& score);
std::string ScoreHeader();

/// Finds the mean of all balls of a body, in the body's frame.
Eigen::Vector3d BallCentroid(const Body& body);

/// Moves a pose's covariance (δθ, δt) to the position of a point of the body [mm²].
Eigen::Matrix3d PositionCovariance(const PoseEstimate& pose, const Eigen::Vector3d& p_in_body_mm);

}  // namespace stereomotion::testing
