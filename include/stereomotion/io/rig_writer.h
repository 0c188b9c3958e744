#pragma once

#include <optional>
#include <string>

#include "stereomotion/camera/rig.h"

namespace stereomotion {

/// Says where a rig's numbers come from: the `calibration:` block of rig.yaml, for people. What is
/// empty is left out.
struct CalibrationRecord {
  std::string date;     ///< ISO 8601, UTC; from the caller, so that the same input gives one text
  std::string program;  ///< name and version
  std::string source;   ///< the file that was calibrated from, or converted
  std::string target;   ///< kind of target
  std::optional<int> views;
  std::optional<double> rms_px;  ///< per coordinate
  std::optional<double> chi2_dof;
  std::optional<double> check_points_rms_mm;
  std::optional<double> cross_validation_rms_mm;
};

/// Spells a rig as rig.yaml (stereomotion-rig/1). Every number has the digits that give it back
/// exactly, whatever the locale; what is not finite throws std::invalid_argument, as do cameras
/// without a size.
std::string RigYaml(const Rig& rig, const CalibrationRecord& record = {});

}  // namespace stereomotion
