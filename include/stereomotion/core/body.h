#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

namespace stereomotion {

/// Describes one marker rod: balls on a line, in the order in which they are threaded.
struct Rod {
  std::string name;
  double ball_diameter_mm = 0;
  std::vector<Eigen::Vector3d> balls_in_body_mm;  ///< ball centres, body frame
  double sigma_mm = 0;  ///< standard uncertainty of every coordinate; 0: taken as exact
};

/// Describes a rigid body by its rods.
struct Body {
  std::string name;
  std::vector<Rod> rods;
  /// Covariance of all balls' coordinates together (3M×3M; rod by rod, ball by ball, x y z); goes
  /// before the rods' `sigma_mm`. Empty: none. It may be singular: a learned body's is in its
  /// gauge.
  Eigen::MatrixXd covariance_mm2{};
};

/// Names one ball of a body: its rod and its place on the rod, both from 0.
struct BallId {
  int rod = -1;
  int ball = -1;
  friend bool operator==(const BallId& a, const BallId& b) {
    return a.rod == b.rod && a.ball == b.ball;
  }
};

/// Counts the balls of all rods.
std::size_t CountBalls(const Body& body);

/// Finds the mean of points; zero where there are none.
Eigen::Vector3d Centroid(const std::vector<Eigen::Vector3d>& points_mm);

/// Finds the centroid of all balls, body frame.
Eigen::Vector3d Centroid(const Body& body);

/// Gives the covariance of all balls' coordinates (3M×3M, as `Body::covariance_mm2`): that of the
/// body, or else the rods' `sigma_mm` on the diagonal. Throws std::invalid_argument where the
/// body's has not the size of its balls.
Eigen::MatrixXd CovarianceOfBalls(const Body& body);

/// Finds the largest standard uncertainty of any ball's coordinate [mm].
double LargestBallSigmaMm(const Body& body);

}  // namespace stereomotion
