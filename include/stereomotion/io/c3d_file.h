#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

namespace stereomotion {

/// Holds the points of a C3D file (c3d.org, format of 1987; residual −1 marks a missing point).
struct C3dPoints {
  std::vector<std::string> labels;
  double rate_hz = 0;
  int first_frame = 1;
  double mm_per_unit = 1;  ///< from POINT:UNITS
  /// frames × points, mm; missing ones hold NaN in memory only.
  std::vector<std::vector<Eigen::Vector3d>> points_mm;
};

/// Reads the points of a C3D (or N3D: see docs/formats.md) file. Throws `UserError` for files that
/// are cut short or are none.
C3dPoints ReadC3d(const std::filesystem::path& file);

/// Reads the same from memory; `name` stands for the file in messages.
C3dPoints ReadC3dBytes(std::string bytes, const std::string& name);

}  // namespace stereomotion
