#pragma once

#include "stereomotion/motion/motion_data.h"
#include "tests/support/motion_scene.h"
#include "tests/support/truth.h"

namespace stereomotion::testing {

/// Makes the scene of a recording whose motion is known: true poses, measured covariances; frames
/// without a pose are left out. It serves `BoundOf`; nothing can be drawn from it.
MotionScene TrueScene(const MotionData& data, const Truth& truth, bool one_axis);

/// Gives all poses of a scene the same noise, alike in all directions, of the centroid's position
/// and of the rotation: σ of all three components together.
MotionScene WithEvenNoise(MotionScene scene, double position_mm, double rotation_rad);

}  // namespace stereomotion::testing
