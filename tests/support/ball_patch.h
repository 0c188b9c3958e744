#pragma once

#include <Eigen/Core>

#include "src/detection/ball_model.h"

namespace stereomotion::testing {

/// Makes a square patch about its origin, all pixels of the same grey value.
inline BallPatch SquarePatch(int half_width_px, float grey_dn) {
  BallPatch patch;
  const int side = 2 * half_width_px + 1;
  patch.Resize(side * side);
  for (int i = 0; i < patch.size; ++i) {
    patch.u[i] = static_cast<float>(i % side - half_width_px);
    patch.v[i] = static_cast<float>(i / side - half_width_px);
    patch.grey[i] = grey_dn;
  }
  return patch;
}

}  // namespace stereomotion::testing
