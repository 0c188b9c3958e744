#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "stereomotion/camera/rig.h"
#include "stereomotion/core/image_mask.h"
#include "stereomotion/core/image_polygon.h"

namespace stereomotion {

/// Holds a part of a camera's images in which nothing is taken for a ball.
struct MaskRegion {
  ImagePolygon polygon;
  std::string comment;  ///< for a person; written, not read
};

/// Holds the masked parts of one camera's images.
struct CameraMask {
  std::string camera;
  std::vector<MaskRegion> regions;
};

/// Reads a `stereomotion-mask/1` file: polygons a camera of `rig`.
///
/// Throws `UserError` with file, line and key, what was found and what was expected; also for
/// cameras that the rig has not, for corners far outside the image, and for polygons that cover no
/// pixel.
std::vector<CameraMask> ReadMask(const std::filesystem::path& file, const Rig& rig);

/// Spells a mask file; each region's comment stands above it, `comment` at the top.
std::string MaskYaml(const std::vector<CameraMask>& masks, const std::string& comment);

/// Marks the regions of one camera; an empty mask where there are none.
ImageMask MakeMask(const std::vector<CameraMask>& masks, const RigCamera& camera);

}  // namespace stereomotion
