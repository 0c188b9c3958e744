#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "stereomotion/camera/rig.h"

namespace stereomotion {

/// Names the formats that a rig is written in besides its own (docs/conventions.md).
enum class RigFormat { kOpenCvYaml, kOpenCvXml, kKalibr, kAnipose, kRos, kDlt };

/// Names what the image coordinates of 11 DLT coefficients are counted from.
enum class DltPixels {
  kZeroBased,  ///< (0, 0) is the centre of the top-left pixel, v down: this program's own
  kDltdv8,     ///< (1, 1) is that centre, v down
  kDltdv5      ///< u counts from 1; v up: image height − v of `kDltdv8`
};

struct ExportOptions {
  /// Leave out the coefficients that the format cannot hold (Kalibr: k3; DLT: all). Else a rig that
  /// has them is refused.
  bool drop_distortion = false;
  DltPixels dlt_pixels = DltPixels::kZeroBased;
};

/// Holds one file of an export.
struct ExportedFile {
  std::string name;  ///< within the output folder; empty: the output is this one file
  std::string text;
};

/// Holds a rig in a foreign format, with what was lost on the way, for a person.
struct RigExport {
  std::vector<ExportedFile> files;  ///< ROS: left.yaml and right.yaml; else one without name
  std::vector<std::string> notes;
};

/// Spells a rig in a foreign format. Numbers carry all their digits. None of the formats holds the
/// covariance; OpenCV, Kalibr and ROS hold no world either, it becomes the first camera's frame
/// there.
///
/// Throws `UserError` where the format cannot hold the rig: another number of cameras than two
/// (OpenCV, ROS), distortion (`ExportOptions::drop_distortion`), a world origin in the plane of a
/// camera (DLT), one camera before the other (ROS: nothing to rectify).
RigExport ExportRig(const Rig& rig, RigFormat format, const ExportOptions& options = {});

/// Reads a pair of ROS camera_info files as camera_calibration writes them: `plumb_bob`, metres.
/// The relative pose follows from both rectification matrices and the right (or lower) camera's
/// projection matrix: p_right = R_rightᵀ (R_left p_left + (P₀₃/P₀₀, P₁₃/P₁₁, 0)). The world is the
/// left camera's frame. Throws `UserError`.
Rig ReadRosCameraInfo(const std::filesystem::path& left, const std::filesystem::path& right);

/// Tells whether a file looks like `ReadDltCsv` reads it: a table of plain numbers.
bool LooksLikeDlt(const std::filesystem::path& file);

struct DltOptions {
  DltPixels pixels = DltPixels::kZeroBased;
  double mm_per_unit = 1;  ///< length unit of the frame that the coefficients come from
};

/// Holds a rig with what a person should know of how it was read.
struct ImportedRig {
  Rig rig;
  std::vector<std::string> notes;
};

/// Reads 11 DLT coefficients, a column a camera, eleven rows (Abdel-Aziz & Karara 1971):
/// u = (L1 X + L2 Y + L3 Z + L4) / (L9 X + L10 Y + L11 Z + 1), v likewise with L5–L8.
///
/// `sizes_px` holds width and height, one for all cameras or one a camera: the file has none. The
/// skew that the coefficients contain is dropped, and a note says what that amounts to. Throws
/// `UserError`; also where the frame's origin lies behind a camera, which means v counted upwards
/// or a left-handed frame.
ImportedRig ReadDltCsv(const std::filesystem::path& file,
                       const std::vector<Eigen::Vector2i>& sizes_px,
                       const DltOptions& options = {});

}  // namespace stereomotion
