#pragma once

#include <filesystem>

#include "stereomotion/camera/rig.h"

namespace stereomotion {

/// Reads a calibrated rig: `stereomotion-rig/1` YAML, OpenCV FileStorage YAML/XML
/// (`K1 D1 K2 D2 R T` or `M1 D1 M2 D2 R T`, with the image size), Kalibr's camchain.yaml (metres
/// there) or anipose's TOML. Which of them it is, the content tells, not the name.
///
/// Throws `UserError` with file, line or key, what was found and what was expected; also where the
/// numbers are formally right but cannot be meant: metres for millimetres, a principal point
/// outside the image, a quaternion or rotation matrix that is none, a covariance that is none.
Rig ReadRig(const std::filesystem::path& file);

}  // namespace stereomotion
