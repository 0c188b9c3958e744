#pragma once

#include <vector>

#include "stereomotion/camera/camera.h"

namespace stereomotion::testing {

/// Lists lenses from none to strong, all valid over a 1280×1024 image.
inline std::vector<CameraModel> Lenses() {
  return {{1640, 1640, 640, 512, 0, 0, 0, 0, 0},
          {1643, 1644, 639, 494, -0.07, 0.087, 5.8e-4, -3.2e-4, -1.1e-3},
          {1640, 1645, 630, 520, 0.15, 0.1, 1e-3, -1e-3, 0.02},
          {1640, 1635, 650, 500, -0.15, 0.1, -1e-3, 1e-3, -0.02},
          {1100, 1102, 645, 515, -0.15, 0.1, 1e-3, 1e-3, 0}};
}

}  // namespace stereomotion::testing
