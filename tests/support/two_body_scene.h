#pragma once

#include <Eigen/Core>
#include <random>

#include "tests/support/motion_scene.h"

namespace stereomotion::testing {

/// Holds two bodies that share a joint, both in motion.
struct TwoBodyScene {
  MotionScene first, second;
  Eigen::Vector3d center_in_first_mm, center_in_second_mm;
  /// The hinge's axis; of a ball joint not read.
  Eigen::Vector3d axis_in_first, axis_in_second;
};

/// Makes two bodies: the first moves by `first`; the second turns against it by the rotations of
/// `relative` (whose world is the first body) about the joint, `relative.center_in_body_mm` of the
/// second and `relative.center_mm` of the first.
TwoBodyScene MakeTwoBodyScene(const MotionPlan& first, const MotionPlan& relative,
                              std::mt19937_64& rng);

}  // namespace stereomotion::testing
