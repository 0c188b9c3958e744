#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "stereomotion/camera/rig.h"

namespace stereomotion::app {

/// Says which recorded stream and which camera of the rig one CAM argument means.
struct ResolvedCamera {
  std::filesystem::path path;  ///< folder or video
  int rig_camera = 0;
};

struct ResolvedCameras {
  ResolvedCamera left, right;
  std::vector<std::string> notes;  ///< what was assumed, for the person
};

/// Resolves `--left` and `--right` (docs/formats.md, "CAM is one of"). Throws `UserError` for live
/// cameras and recording files, which this version does not read, and where both mean one camera.
ResolvedCameras ResolveCameras(const std::string& left, const std::string& right, const Rig& rig,
                               const std::filesystem::path& rig_file);

}  // namespace stereomotion::app
