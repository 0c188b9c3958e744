#pragma once

#include "stereomotion/simulation/scenario.h"

namespace stereomotion::bench {

/// Makes a scene like the usual one: two cameras of 1280×1024 px, 2.5 m away, `rods` rods of five
/// 14 mm balls (some 9 px in the images), ordinary light and noise.
Scenario MakeScene(int rods);

}  // namespace stereomotion::bench
