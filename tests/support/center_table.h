#pragma once

#include "stereomotion/motion/spin_center.h"
#include "tests/support/coverage_table.h"
#include "tests/support/motion_scene.h"

namespace stereomotion::testing {

/// Adds the centre in the body, and the states of the first, the middle and the last frame. A path
/// of order k has k derivatives; the highest is the same in all frames. Along an axis the position
/// is a convention.
void AddCenter(const MotionScene& scene, const SpinCenter& center, CoverageTable& table);

/// States the bounds of what `AddCenter` adds.
void StateBounds(const MotionScene& scene, PathLaw law, CoverageTable& table);

}  // namespace stereomotion::testing
