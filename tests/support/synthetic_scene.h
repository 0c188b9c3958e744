#pragma once

#include <Eigen/Core>
#include <random>
#include <vector>

#include "stereomotion/camera/rig.h"
#include "stereomotion/core/body.h"
#include "stereomotion/detection/ball_observation.h"
#include "stereomotion/geometry/rigid3.h"
#include "stereomotion/pose/estimate_pose.h"

namespace stereomotion::testing {

/// Makes two distorted, converging cameras, 1280×1024, f ≈ 1650 px, 2.5 m from the world's origin.
Rig MakeConvergingRig();

/// Makes a body of two rods of five 14 mm balls with uneven spacing, not parallel.
Body MakeTwoRodBody();

/// Makes a body of one rod with the given places of its balls along x [mm].
Body MakeRodBody(const std::vector<double>& places_mm);

/// Makes a body of two parallel rods, 120 mm apart, with equal spacing: it can slip along itself.
Body MakeEquallySpacedBody();

/// Draws a pose: any rotation, the body within ± `range_mm` of the world's origin.
Rigid3 RandomPose(std::mt19937_64& rng, double range_mm = 120);

struct ObserveOptions {
  double sigma_px = 0.0033;     ///< mean standard deviation of the outline's centre
  double hide_probability = 0;  ///< of each ball in each camera
  int min_per_rod = 0;          ///< balls that both cameras see, whatever is hidden
  int false_balls = 0;          ///< in each camera, anywhere in the image
  double noise_scale = 1;       ///< 0: exact centres under the same covariance
  bool merge_overlaps = false;  ///< outlines that touch are flagged kPartly and biased
};

/// Holds what an ideal detector gives for one frame pair, shuffled, and the truth about it.
struct ObservedPair {
  std::vector<BallObservation> left, right;
  std::vector<BallAssignment> truth;
};

/// Makes the observations of a body: outline centres with noise of the covariance that they state,
/// which is neither isotropic nor the same for all balls.
ObservedPair Observe(const RigCamera& left, const RigCamera& right, const Body& body,
                     const Rigid3& world_from_body, const ObserveOptions& options,
                     std::mt19937_64& rng);

/// Finds the observation that an assignment names.
inline BallObservation& ObservationOf(ObservedPair& pair, const BallAssignment& assignment) {
  auto& list = assignment.camera == 0 ? pair.left : pair.right;
  return list[static_cast<std::size_t>(assignment.detection)];
}

/// Bounds χ² with many degrees of freedom at z standard deviations (Wilson & Hilferty 1931).
double ChiSquareBound(double dof, double z);

}  // namespace stereomotion::testing
