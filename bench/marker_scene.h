#pragma once

#include <Eigen/Core>
#include <random>
#include <vector>

namespace stereomotion::bench {

/// Places of a segment's markers in the world, a 3×4 matrix a frame [mm].
using MarkerSeries = std::vector<Eigen::Matrix3Xd>;

enum class JointKind {
  kBall,            ///< a segment turns about two axes through a point at rest
  kBallBothMoving,  ///< the same, and the segment that it turns against moves too
  kHinge,           ///< a segment turns about one axis at rest
};

/// Says what is simulated. All numbers of the set-up stand here and in `marker_scene.cc`.
struct MarkerScene {
  JointKind kind = JointKind::kBall;
  double range_rad = 0;          ///< each angle is uniform within ± half of it
  int frames = 200;              ///< independent of each other
  double base_distance_mm = 80;  ///< from the joint to the middle of the base's markers
  double sigma_mm = 1;           ///< Gaussian, of each coordinate of each marker
};

/// Holds one simulated trial. The joint is at `TrueCenter_mm`, a hinge turns about `TrueAxis`.
struct MarkerTrial {
  MarkerSeries moving_mm;
  MarkerSeries base_mm;  ///< markers of the other segment; empty: it rests, and is the world
};

/// The joint's centre: in the world, and where both segments move in the base segment's own frame.
/// Far from the origin, so that nothing gains by leaning towards it.
Eigen::Vector3d TrueCenter_mm();

/// The hinge's axis passes through the centre along it.
Eigen::Vector3d TrueAxis();

/// Gives the four markers of a segment in its own frame (of the base: in the frame in which
/// `TrueCenter_mm` is the joint).
Eigen::Matrix3Xd MovingCluster_mm();
Eigen::Matrix3Xd BaseCluster_mm(double distance_mm);

/// Draws a trial.
MarkerTrial DrawTrial(const MarkerScene& scene, std::mt19937_64& rng);

}  // namespace stereomotion::bench
