#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "stereomotion/calibration/target.h"
#include "stereomotion/camera/camera.h"
#include "stereomotion/core/camera_settings.h"

namespace stereomotion {

/// Says what is known of one camera before it is calibrated, and what shall be estimated.
struct CalibrationCamera {
  std::string name;
  std::string source;              ///< copied to the rig, with
  CameraSettings source_settings;  ///< how that camera is set
  int width_px = 0;
  int height_px = 0;
  /// Which of fx fy cx cy k1 k2 p1 p2 k3 are estimated. Not given: chosen by what the target can
  /// tell.
  std::optional<std::array<bool, CameraModel::kNumParameters>> free;
  /// Start values, and for what is not free the values; nothing: found from the target.
  std::array<std::optional<double>, CameraModel::kNumParameters> initial;
};

/// Names three points that define the world's axes: origin; x axis towards the second; the third
/// in the xy plane, on the side of positive y.
struct WorldPoints {
  /// Indices into `Target::points`; where there are `world_points`, into those.
  int origin = -1, x_axis = -1, xy_plane = -1;
};

/// Holds what a calibration is asked to do.
struct CalibrationSetup {
  Target target;
  std::vector<CalibrationCamera> cameras;
  std::optional<WorldPoints> world;
  /// Wand: surveyed balls that define the world, seen in images of their own. An observation of
  /// one of them has `point` = `target.points.size()` + its index here, and a view of its own.
  std::vector<TargetPoint> world_points;
  double world_ball_diameter_mm = 0;
  std::vector<int> check_points;  ///< control points kept out of the fit
};

}  // namespace stereomotion
