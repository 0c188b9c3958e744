#pragma once

#include <string>

#include "stereomotion/core/camera_settings.h"
#include "yaml_reader.h"

namespace stereomotion {

/// Reads a camera's `source:`: a text, or a block that says besides `camera:` how it is set.
void ReadCameraSource(const YamlReader& node, std::string& source, CameraSettings& settings);

/// Spells a camera's source as `ReadCameraSource` reads it; without settings a quoted text.
std::string CameraSourceText(const std::string& source, const CameraSettings& settings);

}  // namespace stereomotion
