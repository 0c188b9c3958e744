#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "stereomotion/camera/rig.h"

namespace stereomotion {

/// Tells a person one thing about a calibration: snake_case name (docs/formats.md) and words that
/// say what was found and what to do.
struct CalibrationNote {
  std::string name;
  std::string text;
};

/// Holds one observation after the fit.
struct CalibrationResidual {
  int camera = 0;
  int view = 0;
  int point = 0;                                          ///< index into `Target::points`
  Eigen::Vector2d pixel_px = Eigen::Vector2d::Zero();     ///< as observed
  Eigen::Vector2d residual_px = Eigen::Vector2d::Zero();  ///< observed − predicted
  double normalized = 0;  ///< length of the whitened residual; √2 is what noise gives (RMS)
  bool used = true;       ///< false: an outlier, left out of the fit
};

/// Holds the 3D error of a point that was kept out of the fit.
struct CheckPoint {
  int point = 0;
  Eigen::Vector3d error_mm = Eigen::Vector3d::Zero();  ///< triangulated − surveyed
  /// Expected: image noise, calibration and the point's own survey together.
  Eigen::Matrix3d covariance_mm2 = Eigen::Matrix3d::Zero();
  int num_cameras = 0;
};

/// Holds the expected standard uncertainty of a ball's position at one place of the volume.
struct VolumeSigma {
  Eigen::Vector3d p_in_world_mm = Eigen::Vector3d::Zero();
  double random_mm = 0;       ///< image noise of one pair: √(trace of the 3D covariance / 3)
  double calibration_mm = 0;  ///< the rig's covariance, propagated: likewise
};

/// Summarises the points of a k-fold cross-validation: calibrated without them, then triangulated.
struct CrossValidation {
  int folds = 0;
  int num_points = 0;
  double rms_mm = 0;            ///< √(mean of |error|²), all three coordinates together
  double predicted_rms_mm = 0;  ///< √(mean trace of the expected covariance)
};

/// Holds a finished calibration with all that its report tells.
struct Calibration {
  Rig rig;                                   ///< with its covariance
  std::vector<std::string> free_parameters;  ///< what was estimated, as `RigParameterName` spells
  std::vector<Rigid3> world_from_target;     ///< per view
  std::vector<bool> view_used;
  std::vector<Eigen::Vector3d> points_mm;  ///< adjusted coordinates, target frame
  std::vector<CalibrationResidual> residuals;
  double rms_px = 0;  ///< √(mean |residual|²/2) of what was used: per coordinate
  double chi2_dof = 0;
  int dof = 0;
  /// Standard deviation of the image observations relative to what the detector stated (boards: in
  /// px, the detector states none). The covariance of the rig is scaled with it.
  double image_sigma_scale = 1;
  double survey_sigma_scale = 1;  ///< likewise of the control points' survey
  std::vector<CheckPoint> check_points;
  std::optional<CrossValidation> cross_validation;
  std::vector<VolumeSigma> volume;
  std::vector<CalibrationNote> warnings;
};

}  // namespace stereomotion
