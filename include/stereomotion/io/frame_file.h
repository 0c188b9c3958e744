#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <vector>

#include "stereomotion/calibration/calibration_setup.h"
#include "stereomotion/calibration/find_control_points.h"
#include "stereomotion/calibration/target.h"

namespace stereomotion {

/// Holds an image point that was measured elsewhere.
struct MeasuredPoint {
  int point = -1;  ///< index into `Target::points`
  int view = 0;
  Eigen::Vector2d pixel_px = Eigen::Vector2d::Zero();
  std::optional<double> sigma_px;  ///< of each coordinate; nothing: not stated
};

/// Says where one camera's data of a calibration are.
struct FrameCamera {
  std::vector<std::filesystem::path> images;  ///< one a view, in natural order
  std::vector<MeasuredPoint> observations;    ///< instead of images
  std::vector<Seed> seeds;                    ///< control points; may be none
  // What defines the world of a wand: images of surveyed balls and where they are seen.
  std::vector<std::filesystem::path> world_images;
  std::vector<Seed> world_seeds;  ///< indices into the points of `FrameFile::world_target`
};

/// Holds a `stereomotion-frame/1` file with all that it names but the images' content.
struct FrameFile {
  /// `width_px` and `height_px` of a camera are 0 where the file leaves them to the images. `world`
  /// refers to the points of `world_target` where there is one.
  CalibrationSetup setup;
  std::vector<FrameCamera> cameras;  ///< as `setup.cameras`
  int num_views = 0;
  std::optional<Target> world_target;  ///< wand: the surveyed balls of the world (`world_points`)
  /// Every file that was read or is to be read, this one first, each once: for their hashes.
  std::vector<std::filesystem::path> inputs;
};

/// Reads a `stereomotion-frame/1` file (docs/formats.md; calib/frame_*.yaml are the commented
/// examples) and the CSV files that it names.
///
/// Throws `UserError` with file, line and key, what was found and what was expected; also where the
/// numbers cannot be meant: metres for millimetres, points in one plane, a board that looks the
/// same upside down, cameras with different numbers of images.
FrameFile ReadFrame(const std::filesystem::path& file);

/// Reads the `target:` of a `stereomotion-frame/1` file alone: what a board is printed from, before
/// there are images or cameras. Throws `UserError` as `ReadFrame` does.
Target ReadFrameTarget(const std::filesystem::path& file);

}  // namespace stereomotion
