#pragma once

#include <Eigen/Core>
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
};

/// Names one ball of a body: its rod and its place on the rod, both from 0.
struct BallId {
  int rod = -1;
  int ball = -1;
  friend bool operator==(const BallId& a, const BallId& b) {
    return a.rod == b.rod && a.ball == b.ball;
  }
};

}  // namespace stereomotion
