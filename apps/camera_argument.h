#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "stereomotion/camera/rig.h"

namespace stereomotion::app {

/// Says which stream of images and which camera of the rig one CAM argument means.
struct ResolvedCamera {
  std::filesystem::path path;  ///< folder, video or REC.h5:NAME; a live camera: as `live`
  int rig_camera = 0;          ///< −1 where the rig has no cameras
  std::string live;            ///< "aravis:…" or "v4l2:…"; empty: recorded
  CameraSettings settings;     ///< what rig.yaml's `source:` says of a live camera
};

struct ResolvedCameras {
  ResolvedCamera left, right;
  std::vector<std::string> notes;  ///< what was assumed, for the person
};

/// Resolves `--left` and `--right` (docs/formats.md, "CAM is one of"); a rig without cameras stands
/// for none. Throws `UserError` where both mean one camera.
ResolvedCameras ResolveCameras(const std::string& left, const std::string& right, const Rig& rig,
                               const std::filesystem::path& rig_file);

}  // namespace stereomotion::app
