#pragma once

#include "stereomotion/camera/rig.h"
#include "stereomotion/core/pair_source.h"

namespace stereomotion {

/// Tells whether a frame has an image of the size for which its camera was calibrated.
inline bool HasSizeOf(const RigCamera& camera, const Frame& frame) {
  if (frame.image.empty()) return false;
  const ImageView view = frame.image.View();
  return view.width_px == camera.width_px && view.height_px == camera.height_px;
}

}  // namespace stereomotion
