#pragma once

#include <array>
#include <string>

#include "stereomotion/io/rig_export.h"

namespace stereomotion {

// The writers of ExportRig, one a format; what the format cannot hold was dropped before.
std::string OpenCvText(const Rig& rig, bool xml);
std::string KalibrText(const Rig& rig);
std::string AniposeText(const Rig& rig);
std::array<std::string, 2> RosTexts(const Rig& rig);
std::string DltText(const Rig& rig, DltPixels pixels);

/// Maps this program's pixels to those of a DLT file.
Eigen::Matrix3d DltFromPixel(DltPixels pixels, int height_px);

/// Makes [fx 0 cx; 0 fy cy; 0 0 1].
Eigen::Matrix3d CameraMatrix(const CameraModel& model);

}  // namespace stereomotion
