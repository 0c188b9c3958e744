#pragma once

#include <filesystem>
#include <string>

#include "stereomotion/camera/rig.h"
#include "yaml_reader.h"

namespace stereomotion {

// The readers of ReadRig, one a format; each throws `UserError`. The result's numbers are finite;
// whether they can be meant is for `CheckRig`.
Rig ReadOwnRig(const YamlReader& root);
Rig ReadKalibrRig(const YamlReader& root);
Rig ReadOpenCvRig(const std::filesystem::path& file);
Rig ReadAniposeRig(const std::filesystem::path& file);

/// Reads rig.yaml's `covariance:` for the cameras of `rig`.
RigCovariance ReadRigCovariance(const YamlReader& node, const Rig& rig);

/// Refuses a rig whose numbers cannot be meant.
void CheckRig(const std::filesystem::path& file, const Rig& rig);

/// Makes a rigid motion of a rotation matrix that may carry rounding errors; `place` names it in
/// the error message where it is no rotation.
Rigid3 MakeRigid(const std::string& place, const Eigen::Matrix3d& rotation,
                 const Eigen::Vector3d& translation_mm);

}  // namespace stereomotion
